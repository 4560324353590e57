// Bundles src/ into three HTML pages, of a run, of a comparison and of a sweep, and writes them as C++ strings; the first as report.html too.
// usage: node build.mjs NODE_MODULES OUTPUT_FOLDER
import { readFile, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const here = path.dirname(fileURLToPath(import.meta.url));
const modules = path.resolve(process.argv[2] ?? path.join(here, 'node_modules'));
const output = path.resolve(process.argv[3] ?? path.join(here, 'dist'));
const esbuild = createRequire(path.join(modules, 'x.js'))('esbuild');

async function bundle(entry) {
  const result = await esbuild.build({
    entryPoints: [path.join(here, 'src', entry)],
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    target: 'es2020',
    charset: 'utf8',
    legalComments: 'none',
    nodePaths: [modules],
    outdir: output,
  });
  return result.outputFiles[0].text.trim();
}

// A replacement given as a function: `$` in the code must not be read as a pattern.
const place = (page, mark, text) => {
  if (!page.includes(mark)) throw new Error(`the page has no ${mark}`);
  return page.replace(mark, () => text);
};

const licences = `<!-- Contains three.js (MIT, three.js authors) and uPlot (MIT, Leon Sorokin). -->\n`;

async function build(html, script) {
  let page = await readFile(path.join(here, 'src', html), 'utf8');
  page = place(page, '<!-- head -->\n', await readFile(path.join(here, 'src/head.html'), 'utf8'));
  page = place(page, '/* style */', await bundle('style.css'));
  page = place(page, '/* script */', await bundle(script));
  page = page.replace('<html', () => `${licences}<html`);
  if (/[\r\0]/.test(page)) throw new Error('the page holds characters that a C++ string would change');
  return page;
}

// Raw literals in pieces that every compiler takes; none of them ends inside a character.
function asFunction(name, page) {
  const pieces = page.match(/[^]{1,12000}/gu).map((piece) => `R"~PAGE~(${piece})~PAGE~"`);
  if (page.includes(')~PAGE~"')) throw new Error('the page holds the delimiter of the string');
  return `std::string_view ${name}() {
  using namespace std::string_view_literals;
  return
${pieces.map((piece, index) => piece + (index === pieces.length - 1 ? 'sv' : '')).join('\n')};
}
`;
}

const report = await build('page.html', 'main.ts');
const comparison = await build('compare.html', 'compare.ts');
const sweep = await build('sweep.html', 'sweep.ts');
const source = `#include "wunderlich/report/report_template.hpp"

namespace wunderlich::report {

${asFunction('report_template', report)}
${asFunction('comparison_template', comparison)}
${asFunction('sweep_template', sweep)}
}  // namespace wunderlich::report
`;
await writeFile(path.join(output, 'report.html'), report);
await writeFile(path.join(output, 'report_template.cpp'), source);
