// Time plots beside the picture: a choice of panels, each with a cursor at the present time.

const DASHES = ["solid", "dash", "dashdot", "longdash", "dot", "longdashdot"];
const STROKES = ["", "6 3", "6 2 2 2", "10 3", "2 2", "10 2 2 2"];
// Panels at once, at most, and the height that each needs, pixels.
const SLOTS = 4, HEIGHT = 200;

function panelsOf(curves) {
  const panels = new Map();
  for (const curve of curves) panels.set(curve.panel, [...panels.get(curve.panel) ?? [], curve]);
  return panels;
}

class Panel {
  constructor(parent, panels, chosen, seek) {
    this.panels = panels;
    this.seek = seek;
    this.now = 0;
    const div = parent.appendChild(document.createElement("div"));
    div.className = "panel";
    const head = div.appendChild(document.createElement("div"));
    this.select = head.appendChild(document.createElement("select"));
    this.select.ariaLabel = "quantity of this plot";
    for (const name of panels.keys()) this.select.add(new Option(name));
    this.select.value = chosen;
    this.keys = head.appendChild(document.createElement("span"));
    this.keys.className = "keys";
    this.plot = div.appendChild(document.createElement("div"));
    this.plot.className = "plot";
    this.curves = this.plot.appendChild(document.createElement("div"));
    this.curves.className = "curves";
    this.cursor = this.plot.appendChild(document.createElement("div"));
    this.cursor.className = "cursor";
    this.select.addEventListener("change", () => this.show());
    new ResizeObserver(() => this.resize()).observe(this.plot);
    this.plot.addEventListener("pointerdown", (event) => this.grab(event));
    this.plot.addEventListener("pointermove", (event) => { if (event.buttons & 1) this.grab(event); });
  }

  async show() {
    this.shown = this.panels.get(this.select.value);
    const axis = { gridcolor: LOOKS.grid, zerolinecolor: LOOKS.light, fixedrange: true, automargin: true };
    const [first, last] = [TIMES[0], TIMES[TIMES.length - 1]];
    const layout = {
      margin: { l: 55, r: 12, t: 6, b: 34 }, font: { ...FONT, size: 11 }, showlegend: false, dragmode: false,
      hovermode: "x unified", plot_bgcolor: "#fff", paper_bgcolor: "#fff",
      xaxis: { ...axis, range: [first, last], title: { text: "t [s]", standoff: 4 }, unifiedhovertitle: { text: "t = %{x:.4g} s" } },
      yaxis: { ...axis, title: { text: `[${this.shown[0].unit}]`, standoff: 4 }, exponentformat: "power", minexponent: 5 },
    };
    const traces = this.shown.map((curve, i) => ({
      type: "scatter", mode: "lines", name: curve.name, x: curve.t.values, y: curve.values.values,
      line: { color: LOOKS.curves[i % 6], dash: DASHES[i % 6], width: 1.6, simplify: false },
      hovertemplate: `%{y:.4g} ${curve.unit}`,
    }));
    this.keys.replaceChildren(...this.shown.map(key));
    this.size = `${this.plot.clientWidth} ${this.plot.clientHeight}`;
    await Plotly.react(this.curves, traces, layout, { displayModeBar: false });
    this.move(this.now);
  }

  async resize() {
    const size = `${this.plot.clientWidth} ${this.plot.clientHeight}`;
    if (!this.curves._fullLayout || !this.plot.clientWidth || size === this.size) return;
    this.size = size;
    await Plotly.Plots.resize(this.curves);
    this.move(this.now);
  }

  // The cursor, and the values there.
  move(t) {
    this.now = t;
    const { xaxis, yaxis } = this.curves._fullLayout ?? {};
    if (!xaxis) return;
    const [first, last] = xaxis.range;
    this.cursor.style.left = `${xaxis._offset + xaxis._length * (t - first) / (last - first)}px`;
    this.cursor.style.top = `${yaxis._offset}px`;
    this.cursor.style.height = `${yaxis._length}px`;
    this.shown.forEach((curve, i) => {
      this.keys.children[i].lastChild.data = `${curve.name} ${written(valueAt(curve, t), 3)} ${curve.unit}`;
    });
  }

  grab(event) {
    const { xaxis } = this.curves._fullLayout;
    const share = (event.clientX - this.plot.getBoundingClientRect().left - xaxis._offset) / xaxis._length;
    const [first, last] = xaxis.range;
    this.seek(first + Math.min(Math.max(share, 0), 1) * (last - first));
  }
}

function key(curve, i) {
  const span = document.createElement("span");
  span.className = "key";
  span.innerHTML = '<svg width="26" height="8"><line x1="0" y1="4" x2="26" y2="4" stroke-width="2"/></svg>';
  const stroke = span.querySelector("line");
  stroke.setAttribute("stroke", LOOKS.curves[i % 6]);
  stroke.setAttribute("stroke-dasharray", STROKES[i % 6]);
  span.append(" ");
  return span;
}

// Between the points of a curve it is straight.
function valueAt(curve, t) {
  const times = curve.t.values, values = curve.values.values, k = placeAt(times, t);
  if (k + 1 >= times.length || t <= times[k]) return values[k];
  return values[k] + (values[k + 1] - values[k]) * (t - times[k]) / (times[k + 1] - times[k]);
}
