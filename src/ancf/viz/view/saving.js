// Pictures and tables for other programs: files that the browser saves, without a network.

// The page's title and what is meant, as the name of a file.
function fileName(what) {
  return `${document.title} ${what}`.replace(/[^\p{L}\p{N}.-]+/gu, "_").slice(0, 80);
}

function saveText(name, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob(["\ufeff", text], { type: "text/csv" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// Columns side by side, each [head, values]; those that are too short end in empty cells.
function tableOf(columns) {
  const count = Math.max(...columns.map(([, values]) => values.length));
  const quoted = (head) => `"${head.replaceAll('"', '""')}"`;
  const lines = [columns.map(([head]) => quoted(head)).join(",")];
  for (let i = 0; i < count; i++) {
    lines.push(columns.map(([, values]) => i < values.length ? String(Number(values[i].toPrecision(8))) : "").join(","));
  }
  return lines.join("\r\n") + "\r\n";
}

// Pairs of columns; what they share stands there once.
function columnsOf(lines, head) {
  const same = lines.every(({ x }) => x.length === lines[0].x.length && x.every((v, i) => v === lines[0].x[i]));
  return lines.flatMap(({ name, unit, x, y }, i) => [...same && i > 0 ? [] : [[head, x]], [`${name} [${unit}]`, y]]);
}

// A figure in print size, as a copy that has a title and a legend.
async function savePicture(figure, title, what) {
  const layout = { ...figure.layout, width: undefined, height: undefined, title: { text: title, font: FONT, x: 0.5 },
                   margin: { ...figure.layout.margin, t: 40 } };
  const size = figure.getBoundingClientRect();
  const copy = { data: figure.data, layout, config: { plotlyServerURL: "" } };
  await Plotly.downloadImage(copy, { format: "png", scale: 2, width: Math.max(size.width, 500),
                                     height: Math.max(size.height, 320), filename: fileName(what) });
}

function button(text, label, act) {
  const made = document.createElement("button");
  Object.assign(made, { type: "button", textContent: text, title: label, ariaLabel: label, className: "save" });
  made.addEventListener("click", act);
  return made;
}
