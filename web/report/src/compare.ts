// The page of a comparison: one view a model, all at the same share of their runs, and the table of figures.
import { readModels, type ModelRun } from './compare_data';
import type { Frame } from './data';
import { byId, element, number, seconds } from '../../shared/format';
import { createViewer, type Viewer } from './viewer';

type Row = [string, (model: ModelRun) => string];

const given = (value: number | null, digits: number) => (value === null ? '–' : number(value, digits));
const took = (value: number | null, unit = 1) => (value === null ? '–' : seconds(unit * value));

const rows: Row[] = [
  ['method', (m) => m.method],
  ['resolution', (m) => m.resolution],
  ['unknowns', (m) => String(m.unknowns)],
  ['constraints', (m) => String(m.constraints)],
  ['elastic energy V·l/(D·w)', (m) => given(m.normalized, 5)],
  ['elastic, kinetic, gravity [J]', (m) => [m.elastic, m.kinetic, m.gravity].map((e) => given(e, 3)).join(', ')],
  ['relative area error', (m) => given(m.area_error, 3)],
  ['diagonal strain, largest', (m) => given(m.diagonal_strain, 3)],
  ['rim stretch', (m) => given(m.rim_stretch, 3)],
  ['out of balance, over D/w (the ribbon: over D)', (m) => given(m.imbalance, 3)],
  ['length error of constraints, at the end', (m) => given(m.length_error, 3)],
  ['steps that missed the tolerance', (m) => (m.missed_steps === null ? '–' : `${number(100 * m.missed_steps, 3)} %`)],
  ['steps', (m) => String(m.steps ?? '–')],
  ['time a step, median', (m) => took(m.step_us_median, 1e-6)],
  ['of it', (m) => Object.entries(m.phases_us ?? {}).map(([name, us]) => `${name} ${seconds(1e-6 * us)}`).join(', ') || '–'],
  ['time in all', (m) => took(m.wall_seconds)],
  ['time a simulated second', (m) => (m.moved_seconds ? took(m.wall_per_second) : '–')],
];

function showTable(models: ModelRun[]) {
  const head = element('tr', {}, element('th', {}, ''), ...models.map((m) => element('th', { scope: 'col' }, m.model)));
  const body = rows.map(([name, value]) =>
    element('tr', {}, element('th', { scope: 'row' }, name), ...models.map((m) => element('td', {}, value(m)))));
  byId('table').append(element('table', {}, element('thead', {}, head), element('tbody', {}, ...body)));
}

function tryViewer(model: ModelRun, host: HTMLElement, seenAs: ModelRun): Viewer | null {
  try {
    return createViewer(host, model.run, () => host.classList.add('touched'), seenAs.run);
  } catch {
    host.append(element('p.notice', {}, 'This browser offers no WebGL.'));
    return null;
  }
}

/** A frame index, not whole between two frames, at a load or time. */
function positionAt(frames: Frame[], time: number): number {
  let k = 0;
  while (k < frames.length - 1 && frames[k + 1].time <= time) ++k;
  if (k === frames.length - 1) return k;
  const span = frames[k + 1].time - frames[k].time;
  return k + (span > 0 ? Math.max(0, Math.min(1, (time - frames[k].time) / span)) : 0);
}

/** From the first frame to the last of the model that takes longest. */
function timesOf(models: ModelRun[]): [number, number] {
  const all = models.flatMap((m) => m.run.frames.map((frame) => frame.time));
  return [Math.min(...all), Math.max(...all)];
}

function isDark(): boolean {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
}

function start() {
  const { scene, title, text, program, version, models } = readModels(byId('run').textContent ?? '');
  byId('title').textContent = `${scene}: models side by side`;
  byId('subtitle').textContent = title;
  document.title = `${scene} · models · Wunderlich`;
  byId('scene-text').textContent = text;
  byId('footer').textContent = `${program} ${version}`;
  showTable(models);
  const warnings = models.filter((m) => !m.converged).map((m) => `${m.model} did not converge: ${m.failure}`);
  warnings.push(...models.flatMap((m) => (m.notes ?? []).map((note) => `${m.model}: ${note}`)));
  byId('warnings').append(...warnings.map((words) => element('p.notice', { role: 'note' }, words)));
  const views = models.map((model) => {
    const view = element('div.view', { tabindex: '0', role: 'img', 'aria-label': model.model });
    byId('models').append(element('figure.model', {}, view, element('figcaption', {}, `${model.model}, ${model.resolution}`)));
    return { model, viewer: tryViewer(model, view, models[0]) };
  });
  const applyTheme = () => views.forEach(({ viewer }) => viewer?.setTheme(isDark()));
  byId('theme').addEventListener('click', () => {
    document.documentElement.dataset.theme = isDark() ? 'light' : 'dark';
    applyTheme();
  });
  applyTheme();

  const [from, to] = timesOf(models);
  const scrub = byId<HTMLInputElement>('scrub'), play = byId('play');
  const show = (share: number) => {
    scrub.value = String(share);
    views.forEach(({ model, viewer }) => viewer?.show(positionAt(model.run.frames, from + share * (to - from))));
  };
  let playing = false, before = 0;
  const setPlaying = (on: boolean) => { playing = on; play.textContent = on ? '❚❚' : '▶'; };
  const tick = (now: number) => {
    if (!playing) return;
    show(Math.min(1, Number(scrub.value) + (now - before) / 6000));
    before = now;
    if (Number(scrub.value) >= 1) setPlaying(false);
    else requestAnimationFrame(tick);
  };
  play.addEventListener('click', () => {
    setPlaying(!playing);
    if (!playing) return;
    if (Number(scrub.value) >= 1) show(0);
    before = performance.now();
    requestAnimationFrame(tick);
  });
  scrub.addEventListener('input', () => { setPlaying(false); show(Number(scrub.value)); });
  setPlaying(false);
  show(1);
}

start();
