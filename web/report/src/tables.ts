// Verdicts, key figures, certificate and details.
import type { Run, Summary } from './data';
import { byId, element, number, quantity, seconds } from '../../shared/format';

type Tone = 'good' | 'bad' | 'plain';

function verdict(text: string, tone: Tone): HTMLElement {
  const mark = tone === 'good' ? '✓ ' : tone === 'bad' ? '✕ ' : '';
  return element(`li.${tone}`, {}, mark + text);
}

export function showHeader(run: Run) {
  const s = run.summary;
  byId('title').textContent = s.scene;
  byId('subtitle').textContent = run.title;
  document.title = `${s.scene} · Wunderlich`;
  const list = byId('verdicts');
  list.append(verdict(s.converged ? 'converged' : 'not converged', s.converged ? 'good' : 'bad'));
  if (s.stability) {
    list.append(s.stability.stable ? verdict('stable', 'good')
      : verdict(`unstable: ${s.stability.negative_modes} negative mode${s.stability.negative_modes === 1 ? '' : 's'}`, 'bad'));
  }
  const sound = checks(s).every(holds);
  const isometric = isSoft(s) ? 'isometric to 1 %' : 'isometric';
  list.append(verdict(sound ? isometric : 'constraints violated', sound ? 'good' : 'bad'));
  list.append(verdict(`${s.segments} segments`, 'plain'));
  const warnings = [...(s.failure ? [s.failure] : []), ...s.warnings];
  byId('warnings').append(...warnings.map((text) => element('p.notice', { role: 'note' }, text)));
  byId('footer').textContent =
    `${s.program} ${s.version} · ${s.model} · ${s.method} · ${run.recordedFrames} recorded frames`;
}

function figure(name: string, value: string, note: string): HTMLElement {
  return element('div.figure', {}, element('dt', {}, name), element('dd', {}, value), element('small', {}, note));
}

/** A linking number as people write it: halves as fractions. */
function halves(value: number): string {
  const twice = Math.round(2 * value);
  if (Math.abs(2 * value - twice) > 1e-6) return number(value, 4);
  const whole = Math.trunc(twice / 2);
  const sign = twice < 0 ? '−' : '';
  return twice % 2 === 0 ? number(whole) : `${sign}${whole === 0 ? '' : Math.abs(whole)}½`;
}

export function showFigures(run: Run) {
  const s = run.summary;
  const list = element('dl');
  list.append(figure('Elastic energy', number(s.energy.normalized, 6), 'V·l/(D·w)'));
  const last = run.frames[run.frames.length - 1].fields;
  const most = (values: Float32Array) => values.reduce((size, value) => Math.max(size, Math.abs(value)), 0);
  list.append(figure('Largest curvature', quantity(most(last.kappa), '1/m', 4), `times l: ${number(most(last.kappa) * run.length, 4)}`));
  if (s.closure_error !== undefined) {
    list.append(figure('Linking number', halves(s.topology.link),
      `twist ${number(s.topology.twist, 4)}, writhe ${number(s.topology.writhe, 4)}`));
  } else {
    list.append(figure('Twist', quantity(s.topology.twist, 'turns', 3), 'of the frame about the centerline'));
  }
  list.append(figure('Solved in', seconds(s.timing.wall_seconds),
    `${s.steps} step${s.steps === 1 ? '' : 's'}, ${number(s.timing.iterations_mean, 3)} iterations each`));
  byId('figures').append(list);
}

/** Without a limit an error is reported, not judged. */
interface Check { name: string; text: string; value: number; limit?: number }

const holds = (check: Check) => check.limit === undefined || check.value <= check.limit;

/** The two-stage method couples centerline and frames softly, and so holds the area to the paper's per cent only. */
const isSoft = (s: Summary) => s.method === 'two-stage';

function checks(s: Summary): Check[] {
  const c = s.constraints, soft = isSoft(s), hard = soft ? 1e-6 : 1e-9;
  const list: Check[] = [
    { name: 'Length', text: 'segments keep their length', value: c.max_length_error, limit: 1e-9 },
    { name: 'Parallel', text: soft ? 'the tangent is d₃; soft here' : 'the tangent is d₃', value: c.max_parallel_error,
      limit: soft ? undefined : hard },
    { name: 'Geodesic', text: 'no binormal bending, γ = 0', value: c.max_binormal, limit: hard },
    { name: 'Torsion', text: 'τ = κ η', value: c.max_torsion_mismatch, limit: hard },
    { name: 'Area', text: 'of the surface is l\u202f·\u202fw', value: s.area_error, limit: soft ? 1e-2 : 1e-10 },
    { name: 'Rulings', text: 'do not meet: |wη′/2|', value: c.max_ruling_ratio, limit: 1 },
  ];
  if (s.closure_error !== undefined) {
    list.push({ name: 'Closure', text: 'the ends meet', value: s.closure_error, limit: 1e-9 });
  }
  return list;
}

/** Where a value lies between rounding and its tolerance, in per cent of the bar. */
function barPercent(check: Check): number {
  if (check.limit === 1) return Math.min(100, 100 * check.value);
  if (check.value <= 0) return 0;
  const floor = -17, top = Math.log10(check.limit ?? 1);
  return Math.max(2, Math.min(100, (100 * (Math.log10(check.value) - floor)) / (top - floor)));
}

export function showCertificate(run: Run) {
  const body = element('tbody');
  for (const check of checks(run.summary)) {
    const pass = holds(check), judged = check.limit !== undefined;
    const bar = element('div.bar', { 'aria-hidden': 'true' });
    bar.append(element(`i.${pass ? 'good' : 'bad'}`, { style: `width:${barPercent(check).toFixed(1)}%` }));
    body.append(element('tr', {},
      element('th', { scope: 'row' }, check.name, element('small', {}, check.text)),
      element('td.value', {}, number(check.value, 3), bar),
      element('td.limit', {}, check.limit === undefined ? '–' : `${check.limit === 1 ? '<' : '≤'} ${number(check.limit, 1)}`),
      judged ? element(`td.mark.${pass ? 'good' : 'bad'}`, {}, pass ? '✓' : '✕', element('span.hidden', {}, pass ? 'holds' : 'violated'))
        : element('td.mark')));
  }
  const head = element('thead', {}, element('tr', {}, ...['Constraint', 'Largest error', 'Tolerance', ''].map((text) =>
    text ? element('th', { scope: 'col' }, text) : element('td'))));
  byId('certificate').append(element('table', {}, head, body));
}

function rows(title: string, entries: [string, string][]): HTMLElement {
  const list = element('dl.rows');
  for (const [name, value] of entries) list.append(element('div', {}, element('dt', {}, name), element('dd', {}, value)));
  return element('div.group', {}, element('h3', {}, title), list);
}

const vector = (v: number[], unit: string) => `(${v.map((x) => number(x, 4)).join(', ')})\u202f${unit}`;

export function showDetails(run: Run) {
  const s = run.summary;
  const host = byId('details');
  const e = s.energy;
  host.append(rows('Energy', [
    ['elastic', quantity(e.elastic, 'J', 7)], ['kinetic', quantity(e.kinetic, 'J')],
    ['gravity', quantity(e.gravity, 'J')], ['total', quantity(e.total, 'J', 7)],
  ]));
  const zeros = s.kappa_zeros.length ? s.kappa_zeros.map((z) => number(z, 4)).join(', ') : 'none';
  host.append(rows('Shape', [
    ['twist', quantity(s.topology.twist, 'turns', 6)], ['writhe', number(s.topology.writhe, 6)],
    ['twist + writhe', number(s.topology.link, 8)], ['κ = 0 at u/l', zeros],
  ]));
  s.ends.forEach((end, i) => host.append(rows(i === 0 ? 'Support at the start' : 'Support at the end', [
    ['force', vector(end.force, 'N')], ['torque', vector(end.torque, 'N m')],
  ])));
  if (s.stability) {
    host.append(rows('Stability', [
      ['state', s.stability.stable ? 'stable' : 'unstable'], ['negative modes', String(s.stability.negative_modes)],
    ]));
  }
  if (s.contact) {
    host.append(rows('Contact', [['contacts', String(s.contact.count)],
      ['penetration', quantity(s.contact.max_penetration, 'm')], ['smallest distance', quantity(s.contact.minimum_distance, 'm')]]));
  }
  const t = s.timing;
  host.append(rows('Time', [
    ['solver', seconds(t.wall_seconds)],
    ...(t.phases ?? []).map((phase): [string, string] => [`· ${phase.name}`, seconds(phase.seconds)]),
    ['step, median', seconds(t.step_us_median * 1e-6)], ['step, 95th percentile', seconds(t.step_us_p95 * 1e-6)],
    ['iterations a step', number(t.iterations_mean, 3)],
  ]));
}

export function showScene(run: Run) {
  const list = element('dl.rows');
  for (const [name, value] of run.parameters) {
    list.append(element('div', {}, element('dt', {}, name), element('dd', {}, value)));
  }
  byId('parameters').append(list);
  byId('scene-text').textContent = run.scene;
}
