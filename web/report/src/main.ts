// Puts the page together: one position in time, shown everywhere.
import { fieldLabels, gradient } from '../../shared/colour';
import { fieldRange, readRun, type FieldName, type Run } from './data';
import { byId, element, number } from '../../shared/format';
import { createHistory, createProfiles } from './plots';
import { showCertificate, showDetails, showFigures, showHeader, showScene } from './tables';
import { createViewer, type Colour, type Viewer } from './viewer';

const icons = {
  play: '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M6 3.8v12.4L16.5 10z" fill="currentColor"/></svg>',
  pause: '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M5 4h3.6v12H5zm6.4 0H15v12h-3.6z" fill="currentColor"/></svg>',
};
const playSeconds = 6;   // a whole run at speed 1

function tryViewer(run: Run): Viewer | null {
  const host = byId('view');
  try {
    return createViewer(host, run, () => host.classList.add('touched'));
  } catch {
    host.append(element('p.notice', {}, 'This browser offers no WebGL, so the ribbon cannot be drawn. Plots and tables are complete.'));
    return null;
  }
}

function isDark(): boolean {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
}

function connectTheme(viewer: Viewer | null) {
  const apply = () => {
    viewer?.setTheme(isDark());
    document.dispatchEvent(new Event('themechange'));
  };
  byId('theme').addEventListener('click', () => {
    document.documentElement.dataset.theme = isDark() ? 'light' : 'dark';
    apply();
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', apply);
  apply();
}

function showLegend(run: Run, colour: Colour) {
  const legend = byId('legend');
  legend.hidden = colour === 'none';
  if (colour === 'none') return;
  const { symbol, text, unit } = fieldLabels[colour];
  const range = fieldRange(run.frames, colour);
  byId('legend-name').textContent = `${symbol}, ${text}${unit ? ` [${unit}]` : ''}`;
  byId('legend-low').textContent = number(-range, 3);
  byId('legend-high').textContent = number(range, 3);
  byId('legend-bar').style.background = gradient();
}

function connectTools(run: Run, viewer: Viewer) {
  const options: [Colour, string, string][] = [['none', 'paper', 'Paper']];
  if (run.pointU) {
    for (const name of Object.keys(fieldLabels) as FieldName[]) {
      options.push([name, fieldLabels[name].symbol, fieldLabels[name].text]);
    }
  }
  for (const [value, text, title] of options) {
    const input = element('input', { type: 'radio', name: 'colour', value, 'aria-label': title }) as HTMLInputElement;
    input.checked = value === 'none';
    input.addEventListener('change', () => {
      viewer.setColour(value);
      showLegend(run, value);
    });
    byId('colours').append(element('label', { title }, input, element('span', {}, text)));
  }
  const rulings = byId('rulings');
  rulings.addEventListener('click', () => {
    const on = rulings.getAttribute('aria-pressed') !== 'true';
    rulings.setAttribute('aria-pressed', String(on));
    viewer.setRulings(on);
  });
  byId('reset').addEventListener('click', () => viewer.resetView());
}

interface Player { toggle(): void; seek(position: number): void }

/** The timeline: `show` is called with every new position, a frame index that need not be whole. */
function createPlayer(run: Run, timeName: string, show: (position: number, time: number) => void): Player {
  const last = run.frames.length - 1;
  const button = byId('play'), scrub = byId<HTMLInputElement>('scrub'), clock = byId('clock');
  const speed = byId<HTMLSelectElement>('speed');
  let position = last, playing = false, before = 0;

  function seek(value: number) {
    position = Math.max(0, Math.min(last, value));
    const k = Math.min(Math.max(0, last - 1), Math.floor(position));
    const a = run.frames[k].time, b = run.frames[Math.min(last, k + 1)].time;
    const time = a + (b - a) * (position - k);
    scrub.value = String(position);
    const text = `${timeName} ${number(time, 3)}`;
    scrub.setAttribute('aria-valuetext', text);
    clock.textContent = text;
    show(position, time);
  }
  function setPlaying(on: boolean) {
    playing = on;
    button.innerHTML = on ? icons.pause : icons.play;
    button.setAttribute('aria-label', on ? 'Pause' : 'Play');
  }
  function tick(now: number) {
    if (!playing) return;
    seek(position + ((now - before) / 1000 / playSeconds) * last * Number(speed.value));
    before = now;
    if (position >= last) setPlaying(false);
    else requestAnimationFrame(tick);
  }
  function toggle() {
    if (last === 0) return;
    setPlaying(!playing);
    if (!playing) return;
    if (position >= last) position = 0;
    before = performance.now();
    requestAnimationFrame(tick);
  }
  scrub.max = String(last);
  scrub.addEventListener('input', () => { setPlaying(false); seek(Number(scrub.value)); });
  button.addEventListener('click', toggle);
  setPlaying(false);
  if (last === 0) document.querySelector('.player')?.setAttribute('hidden', '');
  return { toggle, seek };
}

function connectKeys(viewer: Viewer, player: Player) {
  const step = Math.PI / 24;
  const actions: Record<string, () => void> = {
    ArrowLeft: () => viewer.turn(-step, 0), ArrowRight: () => viewer.turn(step, 0),
    ArrowUp: () => viewer.turn(0, step), ArrowDown: () => viewer.turn(0, -step),
    '+': () => viewer.zoom(0.9), '=': () => viewer.zoom(0.9), '-': () => viewer.zoom(1 / 0.9), ' ': () => player.toggle(),
    Home: () => viewer.resetView(),
  };
  byId('view').addEventListener('keydown', (event) => {
    const action = actions[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  });
}

function frameAt(run: Run, time: number): number {
  let best = 0;
  run.frames.forEach((frame, k) => {
    if (Math.abs(frame.time - time) < Math.abs(run.frames[best].time - time)) best = k;
  });
  return best;
}

function start() {
  const run = readRun(byId('run').textContent ?? '');
  const timeName = run.summary.method === 'equilibrium' ? 'load' : 'time';
  showHeader(run);
  showFigures(run);
  showCertificate(run);
  showDetails(run);
  showScene(run);
  let viewer: Viewer | null = null;
  const profiles = createProfiles(run, (node) => viewer?.mark(node));
  const history = createHistory(run, timeName, (time) => player.seek(frameAt(run, time)));
  const player = createPlayer(run, timeName, (position, time) => {
    viewer?.show(position);
    profiles.show(position);
    history.show(time);
    byId('plot-time').textContent = `at ${timeName} ${number(time, 3)}`;
  });
  player.seek(run.frames.length - 1);
  setTimeout(() => {   // plots and tables first: compiling the shaders may take a moment
    viewer = tryViewer(run);
    connectTheme(viewer);
    if (!viewer) return;
    connectTools(run, viewer);
    connectKeys(viewer, player);
    viewer.show(run.frames.length - 1);
  });
}

start();
