// usage: node validate.cjs NODE_MODULES FILE...     prints a JSON list: of each file what the validator found
const { readFileSync } = require('node:fs');
const path = require('node:path');
const [modules, ...files] = process.argv.slice(2);
const validator = require(path.join(path.resolve(modules), 'gltf-validator'));

async function report(file) {
  const found = await validator.validateBytes(new Uint8Array(readFileSync(file)), { uri: path.basename(file) });
  const { numErrors, numWarnings, numInfos, numHints, messages } = found.issues;
  return { counts: [numErrors, numWarnings, numInfos, numHints], messages: messages.slice(0, 5), info: found.info };
}

Promise.all(files.map(report)).then((reports) => console.log(JSON.stringify(reports)));
