// The three-dimensional picture: axes, camera, colours, and drawing of one state.

const AXES = ["x", "y", "z"];
// Height of what the camera sees, in units of the axes' lengths, less room for their labels.
const SEEN = { perspective: 1.55, orthographic: 1.65 };
// Width for labels and the colour bar beside them, pixels.
const BESIDE = 150;
// Height for labels and the title below a flat view, pixels.
const TITLED = 80;
// Width of a picture below which the colour bar lies under it; room for labels beside and below then, and the bar's
// share of the height.
const NARROW = 480, LABELS = 70, BELOW = 60, UNDER = 0.16;
// Room at both ends of an axis at which labels of another are centred, pixels, and the part of the height that is drawn in.
const LABELLED = 34, DRAWN = 0.5;
// Length of a window that follows a point, m, and from which slenderness on the axes are stretched.
const WINDOW = 120, SLENDER = 8;

// Buttons of the picture: none of them sends anything anywhere.
const CONFIG = {
  displaylogo: false, scrollZoom: true, showSendToCloud: false, plotlyServerURL: "",
  modeBarButtons: [["zoom3d", "pan3d", "orbitRotation"], ["resetCameraDefault3d"]],
};

const VIEWS = {
  "3-D": { eye: { x: 1.0, y: -2.15, z: 0.8 }, up: { x: 0, y: 0, z: 1 }, type: "perspective" },
  "front (x, z)": { eye: { x: 0, y: -2, z: 0 }, up: { x: 0, y: 0, z: 1 }, type: "orthographic" },
  "side (y, z)": { eye: { x: 2, y: 0, z: 0 }, up: { x: 0, y: 0, z: 1 }, type: "orthographic" },
  "top (x, y)": { eye: { x: 0, y: 0, z: 2 }, up: { x: 0, y: 1, z: 0 }, type: "orthographic" },
};

// Unit vectors to the right and upwards on the screen.
function directions(eye, up) {
  const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
  const unit = (a) => a.map((value) => value / Math.hypot(...a));
  const right = unit(cross(up, eye));
  return [right, unit(cross(eye, right))];
}

function webgl() {
  const canvas = document.createElement("canvas");
  return Boolean(window.WebGLRenderingContext && (canvas.getContext("webgl2") || canvas.getContext("webgl")));
}

class Picture {
  constructor(div) {
    this.div = div;
    this.followed = null;
    this.busy = false;
    this.held = false;
    this.shown = 0;
    this.aimed = null;  // what the mouse points at
    this.hidden = new Set();
  }

  // What is drawn from now on; the looks that were chosen stay.
  load(scene, traces) {
    const first = !this.scene;
    this.scene = scene;
    this.layers = layersOf(scene, traces);
    const [low, high] = scene.box;
    this.middle = AXES.map((_, i) => (low[i] + high[i]) / 2);
    this.extent = AXES.map((_, i) => high[i] - low[i]);
    this.order = [0, 1, 2].sort((a, b) => this.extent[b] - this.extent[a]);
    this.long = this.order[0];
    this.size = this.extent[this.long] || 1;
    if (!first) return;
    this.color = scene.quantities.some((q) => q.name === DATA.color) ? DATA.color : "plain";
    const across = this.extent[this.order[1]];
    this.stretched = across > 0 && this.size > SLENDER * across;
    this.view = this.flatView() ?? "3-D";
  }

  narrow() { return this.div.clientWidth < NARROW; }

  // The view along the axis in which nothing extends.
  flatView() {
    const [, middle, short] = this.order, across = this.extent[middle];
    if (this.extent[short] > 0.02 * (across || this.size)) return null;
    return ["side (y, z)", "front (x, z)", "top (x, y)"][short];
  }

  // Ranges of the axes at state k: of the whole run, or a window about the point that is followed.
  ranges(k) {
    const least = this.stretched ? 0.08 * this.extent[this.order[1]] : 0.04 * this.size;
    const labels = this.labelRoom();
    const ranges = this.extent.map((extent, i) => {
      const half = extent / 2 + Math.max(0.06 * extent, least, labels[i]);
      return [this.middle[i] - half, this.middle[i] + half];
    });
    if (this.followed) {
      const centre = this.followed(k)[this.long], half = Math.min(WINDOW, this.size) / 2;
      ranges[this.long] = [centre - half, centre + half];
    }
    return ranges;
  }

  // By axis the room in m that labels at its end need, in flat views to scale.
  labelRoom() {
    const { eye, up, type } = VIEWS[this.view], { clientWidth: width, clientHeight: height } = this.div;
    if (type !== "orthographic" || this.stretched || !width || !height) return [0, 0, 0];
    const above = AXES.findIndex((axis) => up[axis]), across = AXES.findIndex((axis) => !up[axis] && !eye[axis]);
    const metre = Math.min(DRAWN * height / this.extent[above], Math.max(width - BESIDE, width / 2) / this.extent[across]);
    return AXES.map((_, i) => i === across && Number.isFinite(metre) ? LABELLED / metre : 0);
  }

  // Lengths of the drawn axes: in proportion, or so that all are well seen; as large as there is room.
  ratios(ranges) {
    const extents = ranges.map(([low, high]) => high - low);
    const across = Math.max(...extents.filter((_, i) => i !== this.long));
    const { clientWidth: width, clientHeight: height } = this.div;
    const share = Math.min(Math.max(0.8 * height / Math.max(width, 1), 0.25), 0.8);
    const shape = !this.stretched ? extents
      : extents.map((extent, i) => i === this.long ? 1 : Math.max(0.07, share * extent / across));
    const { eye, up, type } = VIEWS[this.view], [right, above] = directions(Object.values(eye), Object.values(up));
    const seen = (direction) => shape.reduce((sum, length, i) => sum + length * Math.abs(direction[i]), 0);
    const room = this.narrow() ? [width - LABELS, (1 - UNDER) * height] : [Math.max(width - BESIDE, width / 2), height];
    const wide = room[0] / Math.max(room[1], 1);
    const below = this.narrow() ? BELOW : type === "orthographic" ? TITLED : 0;
    const free = 1 - below / Math.max(room[1], 2 * below, 1);
    const scale = SEEN[type] * Math.min(wide / seen(right), free / seen(above));
    return shape.map((length) => scale * length);
  }

  // How much larger the other axes are drawn, in words.
  stretchText() {
    if (!this.stretched) return "";
    const ranges = this.ranges(0), ratios = this.ratios(ranges);
    const scale = ratios.map((ratio, i) => ratio / (ranges[i][1] - ranges[i][0]));
    const said = AXES.map((axis, i) => [axis, scale[i] / scale[this.long]]).filter(([, by]) => by > 1.05);
    return "not to scale: " + said.map(([axis, by]) => `${axis} × ${written(by, 2)}`).join(", ");
  }

  axes(k) {
    const ranges = this.ranges(k), ratios = this.ratios(ranges);
    return Object.fromEntries(AXES.map((axis, i) => [`scene.${axis}axis`, {
      tickangle: 0, title: { text: ratios[i] < 0.3 ? "" : `${axis} [m]` }, range: ranges[i], type: "linear",
      nticks: Math.max(i === this.long ? 5 : 2, Math.round(6 * ratios[i])), showticklabels: ratios[i] >= 0.3,
      showbackground: false, showgrid: true, zeroline: true, gridcolor: LOOKS.grid, zerolinecolor: LOOKS.light, showspikes: false,
      ...this.view.startsWith("3-D") ? { ticksuffix: "" } : this.flatAxis(i),
    }]).concat([["scene.aspectratio", Object.fromEntries(AXES.map((axis, i) => [axis, ratios[i]]))],
                ["scene.domain", this.narrow() ? { x: [0, 1], y: [UNDER, 1] } : { x: [0, 0.93], y: [0, 1] }]]));
  }

  // The axis that one looks along shows nothing.
  flatAxis(i) {
    const along = AXES.map((axis) => VIEWS[this.view].eye[axis] !== 0)[i];
    if (along) return { title: { text: "" }, showticklabels: false, showgrid: false, zeroline: false };
    return VIEWS[this.view].up[AXES[i]] ? { title: { text: "" }, ticksuffix: " m" } : { ticksuffix: "" };
  }

  // What moves when a point is followed.
  window(k) {
    return { [`scene.${AXES[this.long]}axis.range`]: this.ranges(k)[this.long] };
  }

  camera() {
    const { eye, up, type } = VIEWS[this.view];
    return { eye, up, center: { x: 0, y: 0, z: 0 }, projection: { type } };
  }

  layout() {
    const layout = {
      margin: { l: 0, r: 0, t: 0, b: 0 }, font: FONT, paper_bgcolor: LOOKS.paper, uirevision: "kept",
      scene: { aspectmode: "manual", camera: this.camera(), uirevision: "kept",
               bgcolor: LOOKS.paper },
      hoverlabel: { bgcolor: LOOKS.paper, bordercolor: LOOKS.light, font: FONT }, showlegend: false,
    };
    for (const [path, value] of Object.entries(this.axes(this.shown))) put(layout, path, value);
    return layout;
  }

  traces() {
    const changes = this.changes(this.shown, true);
    return this.layers.map(({ trace: { kind, first, ...trace } }, i) => {
      for (const [path, value] of Object.entries(changes[i])) put(trace, path, value);
      return { ...trace, visible: !this.hidden.has(trace.name) };
    });
  }

  async start(pick) {
    this.listLayers();
    this.tell();
    this.measure();
    await Plotly.newPlot(this.div, this.traces(), this.layout(), CONFIG);
    new ResizeObserver(() => this.resize()).observe(this.div);
    this.div.on("plotly_hover", ({ points: [point] }) => { this.aimed = point; });
    this.div.on("plotly_unhover", () => { this.aimed = null; });
    this.div.addEventListener("pointerdown", (event) => { this.held = true; this.from = event; });
    for (const end of ["pointerup", "pointercancel"]) window.addEventListener(end, (event) => this.release(event, pick));
  }

  // A click, and no turn of the camera, picks what the mouse points at.
  release(event, pick) {
    const { held, from, aimed } = this;
    this.held = false;
    if (!held || !aimed || event.type !== "pointerup") return;
    if (Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) > 4) return;
    const make = this.layers[aimed.curveNumber]?.pick?.(aimed.pointNumber, this.shown);
    if (make) pick(make);
  }

  listLayers() {
    this.legend = new Legend(document.getElementById("legend"), this);
    this.legend.recolor(this.color);
  }

  // Other data or other colours of the screen.
  async renew(scene, traces) {
    while (this.busy) await new Promise((later) => setTimeout(later, 10));
    this.busy = true;
    try {
      this.load(scene, traces);
      this.shown = Math.min(this.shown, LAST);
      this.listLayers();
      this.tell();
      await Plotly.react(this.div, this.traces(), this.layout(), CONFIG);
    } finally {
      this.busy = false;
    }
  }

  // What is new in each layer at state k: coordinates, and looks where they are to change.
  changes(k, looks) {
    const color = this.color === "plain" ? null : this.color;
    const quantity = this.scene.quantities.find((q) => q.name === color);
    return this.layers.map(({ at, trace, still }) => {
      if (still && !looks) return null;
      return { ...looks ? this.look(trace, quantity) : {}, ...at(k, color) };
    });
  }

  async recolor(color, k) {
    this.color = color;
    this.legend.recolor(color);
    while (!await this.draw(k, true)) await new Promise((later) => setTimeout(later, 30));
  }

  async toggle(name, places, on) {
    if (on) this.hidden.delete(name); else this.hidden.add(name);
    await Plotly.restyle(this.div, { visible: on }, places);
  }

  // Colours of a body's line or solid.
  look({ kind, first, run }, quantity) {
    if (!kind) return {};
    if (!quantity) {
      if (kind === "solid") return { intensity: null, color: LOOKS.light };
      return { "line.color": LOOKS.curves[run], "line.showscale": false, hovertemplate: NAMED };
    }
    const { low, high, unit, name, clipped } = quantity;
    if (kind === "solid") return { colorscale: LOOKS.scale, cmin: low, cmax: high };
    const text = `${name} [${unit}]`, share = clipped ? "(99 % of values)" : "";
    const place = this.narrow()
      ? { orientation: "h", title: { text: `${text} ${share}`.trim(), side: "top", font: FONT }, len: 0.86, x: 0.5, y: 0, yanchor: "bottom", nticks: 5 }
      : { title: { text: text + (share && `<br>${share}`), side: "right", font: FONT }, len: 0.6, x: 1, xpad: 4, y: 0.5 };
    const colorbar = { ...place, thickness: 12, outlinewidth: 0, tickfont: FONT, exponentformat: "power", minexponent: 5 };
    return { "line.colorscale": LOOKS.scale, "line.cmin": low, "line.cmax": high, "line.showscale": first,
             "line.colorbar": colorbar,
             hovertemplate: `%{text}<br>${name} %{customdata:.4g} ${unit}<extra></extra>` };
  }

  // One state; while the camera is turned by hand the picture waits.
  async draw(k, looks = false) {
    if (this.busy || this.held) return false;
    this.shown = k;
    const update = {}, places = [];
    this.changes(k, looks).forEach((change, i) => {
      if (!change) return;
      for (const [path, value] of Object.entries(change)) (update[path] ??= [])[places.length] = value;
      places.push(i);
    });
    for (const values of Object.values(update)) values.length = places.length;
    this.busy = true;
    try {
      await Plotly.update(this.div, update, this.followed ? this.window(k) : {}, places);
    } finally {
      this.busy = false;
    }
    return true;
  }

  tell() {
    document.getElementById("stretch").textContent = this.stretchText();
  }

  // Whether the place for the picture has another size than before.
  measure() {
    const before = this.place;
    this.place = `${this.div.clientWidth} ${this.div.clientHeight}`;
    this.lay = this.narrow();
    return this.place !== before;
  }

  async resize() {
    const narrow = this.lay;
    if (!this.div.clientWidth || !this.measure()) return;
    await Plotly.Plots.resize(this.div);
    await this.relayout(this.shown);
    if (narrow !== this.lay) await this.recolor(this.color, this.shown);
  }

  async relayout(k, camera = false) {
    this.tell();
    await Plotly.relayout(this.div, { ...this.axes(k), ...camera ? { "scene.camera": this.camera() } : {} });
  }
}

// Sets a value inside of others: "line.color".
function put(object, path, value) {
  const keys = path.split("."), last = keys.pop();
  keys.reduce((inner, key) => inner[key] ??= {}, object)[last] = value;
}
