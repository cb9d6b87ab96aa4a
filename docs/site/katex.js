// Reads one formula a line, {"tex": ..., "block": true|false}, and answers with a line {"html": ...} or {"error": ...}.
const katex = require("/usr/share/javascript/katex/katex.js");
require("readline").createInterface({input: process.stdin}).on("line", line => {
  const {tex, block} = JSON.parse(line);
  let answer;
  try {
    answer = {html: katex.renderToString(tex, {displayMode: block, strict: "error", trust: false})};
  } catch (failure) {
    answer = {error: failure.message};
  }
  process.stdout.write(JSON.stringify(answer) + "\n");
});
