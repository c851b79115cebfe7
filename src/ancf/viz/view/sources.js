// What a plot can show: curves over time, quantities along bodies at the present time, and points that were clicked.

// Bodies in the list at most; others get there when they are clicked.
const LISTED = 30;
const OVER_TIME = "over time", ALONG = "along bodies";

class Sources {
  constructor() {
    this.picked = [];  // functions that make the sources of a point that was clicked
    this.bodies = new Set();
  }

  // From the data of the page, which may be new.
  load() {
    this.groups = new Map([[OVER_TIME, new Map()], [ALONG, new Map()]]);
    const curves = unpacked(DATA.curves), ranges = unpacked(DATA.ranges);
    for (const [name, members] of panelsOf(curves)) this.add(OVER_TIME, overTime(name, members));
    const names = [...new Set(SCENE.threads.map((thread) => thread.body))];
    for (const name of names.slice(0, LISTED)) this.bodies.add(name);
    for (const body of this.bodies) this.addBody(body, ranges);
    for (const make of this.picked) for (const source of make()) this.add(source.group, source);
  }

  add(group, source) {
    if (!this.groups.has(group)) this.groups.set(group, new Map());
    this.groups.get(group).set(source.name, source);
  }

  addBody(body, ranges) {
    const threads = SCENE.threads.map((thread, i) => ({ thread, range: ranges[i] })).filter(({ thread }) => thread.body === body);
    if (!threads.length) return;
    for (const { name, unit } of quantitiesAlong()) this.add(ALONG, alongBody(body, name, unit, threads));
  }

  get(name) {
    for (const group of this.groups.values()) if (group.has(name)) return group.get(name);
    return undefined;
  }

  names(group) { return [...this.groups.get(group).keys()]; }

  // Curves of a place that was clicked; the name of the one that the colours show, or of the first.
  pick(make) {
    const found = make();
    if (!found.length) return null;
    if (!this.groups.has(found[0].group)) this.picked.push(make);
    for (const source of found) this.add(source.group, source);
    const color = picture?.color;
    return (found.find((source) => source.quantity === color) ?? found[0]).name;
  }
}

function panelsOf(curves) {
  const panels = new Map();
  for (const curve of curves) panels.set(curve.panel, [...panels.get(curve.panel) ?? [], curve]);
  return panels;
}

// A curve of one of several runs has the run's colour, and the dash of what it is.
function overTime(name, curves) {
  const kinds = [...new Set(curves.map((curve) => curve.name))], several = DATA.runs.length > 1;
  const lines = curves.map((curve, i) => ({
    name: several ? `${DATA.runs[curve.run]}: ${curve.name}` : curve.name, unit: curve.unit,
    x: curve.t.values, y: curve.values.values, scale: curve.scale,
    color: several ? curve.run : i, dash: several ? kinds.indexOf(curve.name) : i,
  }));
  return { name, lines, unit: curves[0].unit, along: false };
}

function quantitiesAlong() {
  const known = SCENE.quantities.map(({ name, unit }) => ({ name, unit }));
  const moved = LAST > 0 ? DATA.moves.filter((_, d) => SCENE.threads.some((thread) => moves(thread, d))) : [];
  return [...known, ...moved.map((name) => ({ name, unit: "m" }))];
}

// Whether a body goes anywhere along an axis.
function moves({ position }, d) {
  const first = position.row(0), size = SCENE.box[1].reduce((most, high, i) => Math.max(most, high - SCENE.box[0][i]), 0);
  for (let k = 1; k < position.count; k += Math.ceil(position.count / 20)) {
    const row = position.row(k);
    for (let i = d; i < row.length; i += 3) if (Math.abs(row[i] - first[i]) > 1e-6 * size) return true;
  }
  return false;
}

// Values of a quantity along a thread at state k.
function valuesAlong(thread, quantity, k) {
  const d = DATA.moves.indexOf(quantity);
  if (d < 0) return thread.values[quantity].row(k);
  const now = thread.position.row(k), first = thread.position.row(0);
  return Float32Array.from(thread.x.values, (_, i) => now[3 * i + d] - first[3 * i + d]);
}

// Extremes over the states of the page, where the page was given no better ones.
function extremes(thread, quantity) {
  const low = Float32Array.from(valuesAlong(thread, quantity, 0)), high = low.slice();
  for (let k = 1; k <= LAST; k++) {
    valuesAlong(thread, quantity, k).forEach((value, i) => {
      if (value < low[i]) low[i] = value;
      if (value > high[i]) high[i] = value;
    });
  }
  return { x: thread.x.values, low, high, states: LAST + 1 };
}

function alongBody(body, quantity, unit, threads) {
  const name = `${quantity} along ${body}`;
  return {
    name, quantity, unit, body, along: true,
    middles: quantity === "tension" && threads.some(({ thread }) => !thread.outline),
    bands() {
      return LAST === 0 ? [] : threads.map(({ thread, range }) => {
        if (!range?.values[quantity]) return { run: thread.run, ...extremes(thread, quantity) };
        const both = range.values[quantity];
        return { run: thread.run, x: range.x.values, low: both.row(0), high: both.row(1), states: range.states };
      });
    },
    at: (k) => threads.map(({ thread }) => ({
      name: DATA.runs.length > 1 ? `${DATA.runs[thread.run]}: ${quantity}` : quantity, unit,
      run: thread.run, x: thread.x.values, y: valuesAlong(thread, quantity, k),
    })),
  };
}

// All quantities over the states of the page at the point of a body that is nearest to s; of every run that has it.
function placeOf(body, s) {
  return () => {
    const group = `at ${body}, s = ${written(s)} m`, times = Array.from(TIMES);
    const threads = SCENE.threads.filter((thread) => thread.body === body);
    if (!threads.length || LAST === 0) return [];
    return quantitiesAlong().map(({ name: quantity, unit }) => {
      const lines = threads.map((thread, i) => {
        const near = nearest(thread.x.values, s);
        const name = DATA.runs.length > 1 ? `${DATA.runs[thread.run]}: ${quantity}` : quantity;
        return { name, unit, x: times, y: times.map((_, k) => valuesAlong(thread, quantity, k)[near]), color: i, dash: i };
      });
      return { group, name: `${quantity} ${group}`, quantity, unit, lines, along: false };
    });
  };
}

// How far a mass, a support or a joint got since the start.
function wayOf(name) {
  return () => {
    const group = `at ${name}`;
    for (const { names, position } of SCENE.markers) {
      const i = names.indexOf(name);
      if (i < 0 || LAST === 0) continue;
      const first = position.row(0), times = Array.from(TIMES);
      const lines = ["x", "y", "z"].map((axis, d) => ({
        name: axis, unit: "m", x: times, color: d, dash: d,
        y: times.map((_, k) => position.row(k)[3 * i + d] - first[3 * i + d]),
      }));
      const moving = lines.filter(({ y }) => y.some((value) => value !== 0));
      return moving.length ? [{ group, name: `displacement ${group}`, unit: "m", lines: moving, along: false }] : [];
    }
    return [];
  };
}

// The force of a spring or of a contact.
function forceOf(things, name) {
  return () => {
    const { names, force } = SCENE[things] ?? { names: [] }, i = names.indexOf(name), times = Array.from(TIMES);
    if (i < 0 || LAST === 0) return [];
    const y = times.map((_, k) => force.row(k)[i]), group = `at ${name}`;
    if (!y.every(Number.isFinite)) return [];
    return [{ group, name: `force ${group}`, unit: "N", along: false,
              lines: [{ name, unit: "N", x: times, y, color: 0, dash: 0 }] }];
  };
}

function nearest(values, wanted) {
  let best = 0;
  values.forEach((value, i) => { if (Math.abs(value - wanted) < Math.abs(values[best] - wanted)) best = i; });
  return best;
}
