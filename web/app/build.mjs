// Bundles src/ into a folder of four files: index.html, app.js, app.css, wunderlich.wasm.
// usage: node build.mjs NODE_MODULES WASM OUTPUT_FOLDER
import { copyFile, mkdir } from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const here = path.dirname(fileURLToPath(import.meta.url));
const [modules, wasm, output] = process.argv.slice(2).map((argument) => path.resolve(argument));
const esbuild = createRequire(path.join(modules, 'x.js'))('esbuild');

await mkdir(output, { recursive: true });
// For node as well: tests and benchmarks call these as the page does.
await esbuild.build({
  entryPoints: ['simulator', 'quality'].map((name) => path.join(here, 'src', `${name}.ts`)), format: 'esm', target: 'es2022',
  outdir: path.join(output, '..'), outExtension: { '.js': '.mjs' },
});
await esbuild.build({
  entryPoints: [{ in: path.join(here, 'src', 'main.ts'), out: 'app' }, { in: path.join(here, 'src', 'style.css'), out: 'app' }],
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'none',
  banner: { js: '/* Contains three.js (MIT, three.js authors) and uPlot (MIT, Leon Sorokin). */' },
  nodePaths: [modules],
  outdir: output,
});
await copyFile(path.join(here, 'src', 'page.html'), path.join(output, 'index.html'));
await copyFile(wasm, path.join(output, 'wunderlich.wasm'));
