// Buttons, choices and keys.
import { byId, element } from '../../shared/format';
import type { Page } from './page';
import type { Colour } from './ribbon';
import type { ShippedScene } from './simulator';

export function connectControls(page: Page, scenes: ShippedScene[]) {
  connectScenes(page, scenes);
  connectColours(page);
  connectTheme(page);
  connectKeys(page);
  const text = byId<HTMLTextAreaElement>('text'), run = () => { page.load(text.value, page.name); };
  const clicks: Record<string, () => void> = {
    rulings: () => page.setRulings(!page.rulings), 'reset-view': () => page.resetView(), play: () => page.clock.toggle(),
    step: () => page.clock.step(), restart: () => page.restart(), 'as-given': () => page.sliders.asGiven(), run,
  };
  for (const [id, work] of Object.entries(clicks)) byId(id).addEventListener('click', work);
  text.addEventListener('keydown', (event) => {
    if (event.key === 'Enter' && (event.ctrlKey || event.metaKey)) run();
  });
  addEventListener('hashchange', () => void page.open());
}

function connectScenes(page: Page, scenes: ShippedScene[]) {
  const select = byId<HTMLSelectElement>('scene');
  const group = (label: string, wanted: boolean) => {
    const options = scenes.filter(({ text }) => /method:\s*equilibrium/.test(text) === wanted)
      .map(({ name }) => element('option', { value: name }, name));
    select.append(element('optgroup', { label }, ...options));
  };
  group('Equilibria', true);
  group('Motions', false);
  select.addEventListener('change', () => page.choose(select.value));
}

function connectColours(page: Page) {
  const options: [Colour, string, string][] = [['none', 'paper', 'Paper'], ['kappa', 'κ', 'curvature'],
    ['tau', 'τ', 'torsion'], ['eta', 'η', 'ruling slope'], ['energy', 'energy', 'energy a length']];
  for (const [value, text, title] of options) {
    const input = element('input', { type: 'radio', name: 'colour', value, 'aria-label': title }) as HTMLInputElement;
    input.checked = value === 'none';
    input.addEventListener('change', () => page.setColour(value));
    byId('colours').append(element('label', { title }, input, element('span', {}, text)));
  }
}

function connectTheme(page: Page) {
  const root = document.documentElement, system = matchMedia('(prefers-color-scheme: dark)');
  const dark = () => (root.dataset.theme ?? (system.matches ? 'dark' : 'light')) === 'dark';
  const apply = () => {
    page.stage.setTheme(dark());
    document.dispatchEvent(new Event('themechange'));
  };
  byId('theme').addEventListener('click', () => {
    root.dataset.theme = dark() ? 'light' : 'dark';
    apply();
  });
  system.addEventListener('change', apply);
  apply();
}

function connectKeys(page: Page) {
  const turn = Math.PI / 24, { hand, stage, clock } = page;
  const pull = (right: number, up: number, towards: number, otherwise: () => void) => () => {
    if (hand.held) hand.moveBy(right * hand.step, up * hand.step, towards * hand.step);
    else otherwise();
  };
  const actions: Record<string, () => void> = {
    ArrowLeft: pull(-1, 0, 0, () => stage.turn(-turn, 0)), ArrowRight: pull(1, 0, 0, () => stage.turn(turn, 0)),
    ArrowUp: pull(0, 1, 0, () => stage.turn(0, turn)), ArrowDown: pull(0, -1, 0, () => stage.turn(0, -turn)),
    PageUp: pull(0, 0, -1, () => {}), PageDown: pull(0, 0, 1, () => {}),
    e: () => hand.choose(false), E: () => hand.choose(true), ',': () => hand.shift(-1), '.': () => hand.shift(1),
    Escape: () => hand.letGo(), q: () => hand.turn(-hand.keyTurn), w: () => hand.turn(hand.keyTurn),
    ' ': () => clock.toggle(), s: () => clock.step(), r: () => page.restart(),
    '+': () => stage.zoom(0.9), '=': () => stage.zoom(0.9), '-': () => stage.zoom(1 / 0.9), Home: () => page.resetView(),
  };
  byId('view').addEventListener('keydown', (event) => {
    const action = actions[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  });
}
