// Formulas in, [[TeX, display], ...] as JSON; their HTML and MathML out.
const katex = require("/usr/share/javascript/katex/katex.js");
const formulas = JSON.parse(require("fs").readFileSync(0, "utf8"));
const set = ([tex, displayMode]) => katex.renderToString(tex, { displayMode, throwOnError: true, strict: "error" });
process.stdout.write(JSON.stringify(formulas.map(set)));
