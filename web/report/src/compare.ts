// The page of a comparison: one view a model, all at the same share of their runs, and the table of figures.
import { readModels, type ModelRun } from './compare_data';
import { byId, element, number, seconds } from './format';
import { createViewer, type Viewer } from './viewer';

type Row = [string, (model: ModelRun) => string];

const rows: Row[] = [
  ['method', (m) => m.method],
  ['resolution', (m) => m.resolution],
  ['unknowns', (m) => String(m.unknowns)],
  ['constraints', (m) => String(m.constraints)],
  ['elastic energy V·l/(D·w)', (m) => number(m.normalized, 5)],
  ['relative area error', (m) => number(m.area_error, 3)],
  ['diagonal strain, largest', (m) => number(m.diagonal_strain, 3)],
  ['rim stretch', (m) => number(m.rim_stretch, 3)],
  ['steps', (m) => String(m.steps)],
  ['time a step, median', (m) => seconds(1e-6 * m.step_us_median)],
  ['time in all', (m) => seconds(m.wall_seconds)],
  ['time a simulated second', (m) => (m.moved_seconds > 0 ? seconds(m.wall_per_second) : '–')],
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

  const scrub = byId<HTMLInputElement>('scrub'), play = byId('play');
  const show = (share: number) => {
    scrub.value = String(share);
    views.forEach(({ model, viewer }) => viewer?.show(share * (model.run.frames.length - 1)));
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
