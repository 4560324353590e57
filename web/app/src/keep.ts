// What can be taken away: a link, and files.
import { byId, element } from '../../shared/format';
import { toFragment, type Shared } from './share';
import type { Simulator } from './simulator';

/** `current`: the scene as a text; it throws if what the sliders say cannot be written. */
export function connectKeep(simulator: Simulator, name: () => string, current: () => string, shared: () => Shared) {
  const kept = (text: string) => { byId('kept').textContent = text; };
  const keep = (id: string, work: () => void | Promise<void>) => byId(id).addEventListener('click', async () => {
    try {
      await work();
    } catch (error) {
      kept((error as Error).message);
    }
  });
  const save = (bytes: BlobPart, type: string, ending: string) => {
    const file = `${name().replace(/\.ya?ml$/, '')}${ending}`;
    const link = element('a', { href: URL.createObjectURL(new Blob([bytes], { type })), download: file }) as HTMLAnchorElement;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    kept(`Saved ${file}.`);
  };
  keep('save-glb', () => save(simulator.glb(), 'model/gltf-binary', '.glb'));
  keep('save-pattern', () => save(simulator.pattern(), 'image/svg+xml', '-pattern.svg'));
  keep('save-scene', () => save(current(), 'text/yaml', '.yaml'));
  keep('share', async () => {
    history.replaceState(null, '', await toFragment(shared()));
    try {
      await navigator.clipboard.writeText(location.href);
      kept('The link is copied; it holds the scene and the sliders.');
    } catch {
      kept('The link is in the address bar; it holds the scene and the sliders.');
    }
  });
}
