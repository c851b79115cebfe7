// Plots beside the picture: each has a choice of what it shows, over time with a cursor, or along a body.

const DASHES = ["solid", "dash", "dashdot", "longdash", "dot", "longdashdot"];
const STROKES = ["", "6 3", "6 2 2 2", "10 3", "2 2", "10 2 2 2"];
// Panels at once, at most, and the height that each needs, pixels.
const SLOTS = 4, HEIGHT = 200;

class Panel {
  constructor(parent, sources, chosen, seek, pick) {
    this.sources = sources;
    this.seek = seek;
    this.pick = pick;
    this.now = 0;
    const div = parent.appendChild(document.createElement("div"));
    div.className = "panel";
    const head = div.appendChild(document.createElement("div"));
    this.select = head.appendChild(document.createElement("select"));
    this.select.ariaLabel = "what this plot shows";
    this.keys = head.appendChild(document.createElement("span"));
    this.keys.className = "keys";
    const saving = head.appendChild(document.createElement("span"));
    saving.className = "saving";
    saving.append(button("png", "save this plot as a picture", () => this.savePicture()),
                  button("csv", "save the numbers of this plot", () => this.saveNumbers()));
    this.plot = div.appendChild(document.createElement("div"));
    this.plot.className = "plot";
    this.curves = this.plot.appendChild(document.createElement("div"));
    this.curves.className = "curves";
    this.cursor = this.plot.appendChild(document.createElement("div"));
    this.cursor.className = "cursor";
    this.list(chosen);
    this.select.addEventListener("change", () => this.show());
    new ResizeObserver(() => this.resize()).observe(this.plot);
    this.plot.addEventListener("pointerdown", (event) => this.grab(event, true));
    this.plot.addEventListener("pointermove", (event) => { if (event.buttons & 1) this.grab(event, false); });
  }

  // What there is to choose from; the choice stays as long as it is there.
  list(chosen = this.select.value) {
    this.select.replaceChildren();
    for (const [group, members] of this.sources.groups) {
      if (!members.size) continue;
      const made = Object.assign(document.createElement("optgroup"), { label: group });
      for (const name of members.keys()) made.append(new Option(name));
      this.select.append(made);
    }
    if (this.sources.get(chosen)) this.select.value = chosen;
  }

  async choose(name) {
    this.list(name);
    await this.show();
  }

  async show() {
    this.shown = this.sources.get(this.select.value);
    this.bands = this.shown.bands?.() ?? [];
    this.plot.classList.toggle("along", this.shown.along);
    this.cursor.hidden = this.shown.along;
    this.keys.replaceChildren(...this.looks().map(key));
    this.write();
    this.size = `${this.plot.clientWidth} ${this.plot.clientHeight}`;
    await Plotly.react(this.curves, this.traces(), this.layout(), { displayModeBar: false });
    this.move(this.now);
  }

  layout() {
    const axis = { gridcolor: LOOKS.grid, zerolinecolor: LOOKS.light, fixedrange: true, automargin: true };
    const { along, unit } = this.shown, [first, last] = [TIMES[0], TIMES[LAST]];
    const across = along
      ? { title: { text: "s [m]", standoff: 4 }, unifiedhovertitle: { text: "s = %{x:.4g} m" } }
      : { range: [first, last], title: { text: "t [s]", standoff: 4 }, unifiedhovertitle: { text: "t = %{x:.4g} s" } };
    const reach = this.reach();
    return {
      margin: { l: 55, r: 12, t: 6, b: 34 }, font: { ...FONT, size: 11 }, showlegend: false, dragmode: false,
      hovermode: "x unified", plot_bgcolor: LOOKS.paper, paper_bgcolor: LOOKS.paper,
      hoverlabel: { bgcolor: LOOKS.paper, bordercolor: LOOKS.light, font: FONT }, xaxis: { ...axis, ...across },
      yaxis: { ...axis, ...reach, title: { text: `[${unit}]`, standoff: 4 }, exponentformat: "power", minexponent: 5 },
    };
  }

  // What the panel has to show, where some curves leave parts of them out of its scale.
  reach() {
    if (this.shown.along || !this.shown.lines.some((line) => line.scale)) return {};
    const ends = this.shown.lines.flatMap(({ scale, y }) => scale ?? leastAndMost(y));
    const [low, high] = leastAndMost(ends), room = 0.06 * (high - low) || 1;
    return { range: [low - room, high + room] };
  }

  traces() {
    const line = ({ name, unit, x, y }, look) => ({
      type: "scatter", mode: "lines", name, x, y, line: { ...look, width: 1.6, simplify: false },
      hovertemplate: `%{y:.4g} ${unit}`,
    });
    if (!this.shown.along) {
      return this.shown.lines.map((l) => line(l, { color: LOOKS.curves[l.color % 6], dash: DASHES[l.dash % 6] }));
    }
    const { unit } = this.shown;
    const edge = { width: 0.8, dash: "dot", simplify: false };
    const around = this.bands.flatMap(({ run, x, low, high }) => {
      const color = LOOKS.curves[run % 6], more = { type: "scatter", mode: "lines", x, line: { ...edge, color } };
      return [{ ...more, y: low, name: "least", hovertemplate: `%{y:.4g} ${unit}` },
              { ...more, y: high, name: "greatest", fill: "tonexty", fillcolor: faint(color), hovertemplate: `%{y:.4g} ${unit}` }];
    });
    this.first = around.length;
    return [...around, ...this.shown.at(frameAt(this.now)).map((l) => line(l, { color: LOOKS.curves[l.run % 6] }))];
  }

  // Colour and dash of what stands in the head.
  looks() {
    if (!this.shown.along) return this.shown.lines;
    return this.shown.at(0).map(({ run }) => ({ color: run, dash: 0 }));
  }

  async resize() {
    const size = `${this.plot.clientWidth} ${this.plot.clientHeight}`;
    if (!this.curves._fullLayout || !this.plot.clientWidth || size === this.size) return;
    this.size = size;
    await Plotly.Plots.resize(this.curves);
    this.move(this.now);
  }

  // Names and values at the present time.
  write() {
    const several = DATA.runs.length > 1;
    const said = !this.shown.along
      ? this.shown.lines.map((line) => `${line.name} ${written(valueAt(line, this.now), 3)} ${line.unit}`)
      : this.shown.at(frameAt(this.now)).map(({ y, run }) => {
        const band = this.bands.find((one) => one.run === run);
        const [low, high] = [Math.min(...band?.low ?? y), Math.max(...band?.high ?? y)].map((value) => written(value, 3));
        return `${several ? DATA.runs[run] + ": " : ""}${low} to ${high} ${this.shown.unit}${band ? ` in ${band.states} states` : ""}${this.shown.middles ? ", middles of elements" : ""}`;
      });
    said.forEach((text, i) => { this.keys.children[i].lastChild.data = text; });
  }

  // The cursor, or the line of the present time.
  move(t) {
    this.now = t;
    this.write();
    const { xaxis, yaxis } = this.curves._fullLayout ?? {};
    if (!xaxis) return;
    if (this.shown.along) {
      this.follow();
      return;
    }
    const [first, last] = xaxis.range;
    this.cursor.style.left = `${xaxis._offset + xaxis._length * (t - first) / (last - first)}px`;
    this.cursor.style.top = `${yaxis._offset}px`;
    this.cursor.style.height = `${yaxis._length}px`;
  }

  async follow() {
    const lines = this.shown.at(frameAt(this.now));
    if (this.busy) return;
    this.busy = true;
    const places = lines.map((_, i) => this.first + i), shown = this.shown;
    try {
      await Plotly.restyle(this.curves, { y: lines.map(({ y }) => y) }, places);
    } finally {
      this.busy = false;
    }
    if (shown !== this.shown) await this.show();
  }

  // A click goes to a time, or plots a place over time.
  grab(event, down) {
    const { xaxis } = this.curves._fullLayout;
    const share = (event.clientX - this.plot.getBoundingClientRect().left - xaxis._offset) / xaxis._length;
    const [first, last] = xaxis.range, value = first + Math.min(Math.max(share, 0), 1) * (last - first);
    if (!this.shown.along) this.seek(value);
    else if (down) this.pick(placeOf(this.shown.body, nearestPlace(this.shown, value)), this, this.shown.quantity);
  }

  saveNumbers() {
    const { along, unit } = this.shown;
    if (!along) {
      saveText(`${fileName(this.shown.name)}.csv`, tableOf(columnsOf(this.shown.lines, "t [s]")));
      return;
    }
    const said = ({ run }, what) => DATA.runs.length > 1 ? `${DATA.runs[run]}: ${what}` : what;
    const lines = this.shown.at(frameAt(this.now)).map((line) => ({ ...line, name: `${line.name} at ${written(this.now)} s` }));
    const around = this.bands.flatMap((band) => [["least", band.low], ["greatest", band.high]].map(([what, y]) =>
      ({ name: said(band, what), unit, x: band.x, y })));
    saveText(`${fileName(this.shown.name)}.csv`, tableOf(columnsOf([...lines, ...around], "s [m]")));
  }

  async savePicture() {
    const named = { data: this.curves.data, layout: { ...this.curves.layout, showlegend: true, legend: { orientation: "h", y: 1.02, yanchor: "bottom" } },
                    getBoundingClientRect: () => this.curves.getBoundingClientRect() };
    await savePicture(named, this.shown.name, this.shown.name);
  }
}

function key({ color, dash }) {
  const span = document.createElement("span");
  span.className = "key";
  span.innerHTML = '<svg width="26" height="8" aria-hidden="true"><line x1="0" y1="4" x2="26" y2="4" stroke-width="2"/></svg>';
  const stroke = span.querySelector("line");
  stroke.setAttribute("stroke", LOOKS.curves[color % 6]);
  stroke.setAttribute("stroke-dasharray", STROKES[dash % 6]);
  span.append(" ");
  return span;
}

function leastAndMost(values) {
  return values.reduce(([low, high], x) => [Math.min(low, x), Math.max(high, x)], [Infinity, -Infinity]);
}

function frameAt(t) {
  return placeAt(TIMES, t);
}

function nearestPlace(source, s) {
  const { x } = source.at(0)[0];
  return x[nearest(x, s)];
}

// Between the points of a curve it is straight.
function valueAt({ x, y }, t) {
  const k = placeAt(x, t);
  if (k + 1 >= x.length || t <= x[k]) return y[k];
  return y[k] + (y[k + 1] - y[k]) * (t - x[k]) / (x[k + 1] - x[k]);
}
