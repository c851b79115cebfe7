// Layers of the three-dimensional picture: a trace for Plotly each, and what changes in it from state to state.
// `at(k, color)` gives its coordinates at state k, and its colours; a layer that is still is drawn once.

// Coordinates of points and lines, one after the other; a gap ends a line.
class Path {
  constructor() { this.x = []; this.y = []; this.z = []; }
  add(xyz, i = 0) { this.x.push(xyz[i]); this.y.push(xyz[i + 1]); this.z.push(xyz[i + 2]); }
  gap() { this.x.push(null); this.y.push(null); this.z.push(null); }
}

const NAMED = "%{text}<extra></extra>";

function line(name, look, more = {}) {
  return { type: "scatter3d", mode: "lines", name, line: look, hovertemplate: NAMED, x: [], y: [], z: [], ...more };
}

function layersOf(scene, traces) {
  const solids = scene.threads.filter((thread) => thread.outline);
  return [
    ...solids.length ? [solidLayer(solids)] : [],
    ...threadGroups(scene.threads).map(([name, threads], i) => threadLayer(name, threads, i === 0)),
    ...scene.links ? [linkLayer(scene.links, false), linkLayer(scene.links, true)] : [],
    ...scene.strips ? [stripLayer(scene.strips)] : [],
    ...scene.triads ? [triadLayer(scene.triads)] : [],
    ...scene.markers.map(markerLayer),
    ...scene.arrows.map(arrowLayer),
    ...scene.combs.length ? [combLayer(scene.combs, false), combLayer(scene.combs, true)] : [],
    ...scene.nets.map((net) => netLayer(net, scene.triads)),
    ...traces.flatMap(traceLayers),
  ];
}

// A few bodies have a line of the legend each, many share one; each of several runs has one.
function threadGroups(threads) {
  if (DATA.runs.length > 1) {
    return DATA.runs.map((name, run) => [name, threads.filter((t) => t.run === run)]).filter(([, members]) => members.length);
  }
  if (threads.length <= 6) return threads.map((thread) => [thread.name, [thread]]);
  const groups = [["cables", threads.filter((t) => t.element === "cable")],
                  ["beams", threads.filter((t) => t.element !== "cable")]];
  return groups.filter(([, members]) => members.length);
}

function threadLayer(name, threads, first) {
  const text = threads.flatMap((t) => [...Array.from(t.x.values, (x) => `${t.name}, s = ${written(x)} m`), ""]);
  const more = { text, kind: "thread", first, run: threads[0].run };
  const trace = line(name, { width: 8, color: LOOKS.blue }, more);
  return {
    trace,
    at(k, color) {
      const path = new Path(), values = [];
      for (const thread of threads) {
        const row = thread.position.row(k);
        for (let i = 0; i < row.length; i += 3) path.add(row, i);
        path.gap();
        if (color) values.push(...thread.values[color].row(k), null);
      }
      return { ...path, ...color ? { "line.color": lastKnown(values), customdata: values } : {} };
    },
    pick(i) {
      for (const { x, body } of threads) {
        if (i < x.values.length) return placeOf(body, x.values[i]);
        i -= x.values.length + 1;
      }
      return null;
    },
  };
}

// A gap takes the colour before it: a missing one would spoil the line's end.
function lastKnown(values) {
  return values.map((value, i) => value === null ? values[i - 1] : value);
}

function solidLayer(threads) {
  const faces = { i: [], j: [], k: [] };
  let base = 0;
  for (const { outline } of threads) {
    const [sections, corners] = outline.shape;
    for (let s = 0; s + 1 < sections; s++) {
      for (let c = 0; c < corners; c++) {
        const a = base + s * corners + c, b = base + s * corners + (c + 1) % corners;
        faces.i.push(a, b); faces.j.push(b, b + corners); faces.k.push(a + corners, a + corners);
      }
    }
    for (const end of [base, base + (sections - 1) * corners]) {
      for (let c = 1; c + 1 < corners; c++) { faces.i.push(end); faces.j.push(end + c); faces.k.push(end + c + 1); }
    }
    base += sections * corners;
  }
  const trace = {
    type: "mesh3d", name: "cross-sections", ...faces, x: [], y: [], z: [], color: LOOKS.light, flatshading: true,
    hoverinfo: "skip", kind: "solid", showscale: false,
    lighting: { ambient: 0.65, diffuse: 0.6, specular: 0.1 },
  };
  return {
    trace,
    at(k, color) {
      const path = new Path(), values = [];
      for (const { position, outline, values: known } of threads) {
        const centres = position.row(k), offsets = outline.row(k), corners = outline.shape[1];
        for (let p = 0; p < offsets.length / 3; p++) {
          const s = Math.floor(p / corners);
          path.add([0, 1, 2].map((d) => centres[3 * s + d] + offsets[3 * p + d]));
          if (color) values.push(known[color].row(k)[s]);
        }
      }
      return { ...path, intensity: color ? values : null };
    },
  };
}

function linkLayer(links, slack) {
  const look = slack ? { width: 2, color: LOOKS.grey, dash: "dash" } : { width: 3, color: LOOKS.grey };
  const ever = links.slack.values.some((value) => value > 0.5);
  const trace = line(slack ? "slack springs" : "springs", look, { text: [] });
  return {
    trace,
    absent: slack && !ever,
    at(k) {
      const path = new Path(), text = [], ends = links.ends.row(k);
      links.names.forEach((name, i) => {
        if ((links.slack.row(k)[i] > 0.5) !== slack) return;
        path.add(ends, 6 * i); path.add(ends, 6 * i + 3); path.gap();
        const said = `${name}: ${slack ? "slack" : written(links.force.row(k)[i]) + " N"}`;
        text.push(said, said, "");
      });
      return { ...path, text };
    },
    pick: (i, k) => {
      const drawn = links.names.filter((_, n) => (links.slack.row(k)[n] > 0.5) === slack);
      return forceOf("links", drawn[Math.floor(i / 3)]);
    },
  };
}

function stripLayer(strips) {
  const trace = line(strips.names.length > 1 ? "strips" : "strip", { width: 10, color: LOOKS.curves[4] }, { text: [] });
  return {
    trace,
    at(k) {
      const path = new Path(), text = [], ends = strips.ends.row(k), force = strips.force.row(k);
      strips.names.forEach((name, i) => {
        path.add(ends, 6 * i); path.add(ends, 6 * i + 3); path.gap();
        const said = Number.isFinite(force[i]) ? `${name}: ${written(force[i])} N` : name;
        text.push(said, said, "");
      });
      return { ...path, text };
    },
    pick: (i) => forceOf("strips", strips.names[Math.floor(i / 3)]),
  };
}

function triadLayer(triads) {
  const colors = [LOOKS.orange, LOOKS.green, LOOKS.blue];
  const color = triads.names.flatMap(() => colors.flatMap((c) => [c, c, c]));
  const text = triads.names.flatMap((name) => ["first", "second", "third"].flatMap((which) => {
    const said = `${name}: ${which} axis`;
    return [said, said, ""];
  }));
  return {
    trace: line("body axes", { width: 5, color }, { text }),
    at(k) {
      const path = new Path(), centres = triads.centre.row(k), axes = triads.axes.row(k);
      triads.names.forEach((_, b) => {
        for (let j = 0; j < 3; j++) {
          const centre = centres.subarray(3 * b, 3 * b + 3);
          path.add(centre);
          path.add([0, 1, 2].map((i) => centre[i] + axes[9 * b + 3 * i + j]));
          path.gap();
        }
      });
      return { ...path };
    },
  };
}

// What plotly has in space; an outline is larger, a slider is a ring about what slides.
const SHAPES3D = { circle: "circle", square: "square", diamond: "cross", up: "diamond", down: "diamond", slider: "circle" };

function markerLayer(group) {
  const slider = group.shape === "slider", open = group.fill === "white" || slider;
  const symbol = SHAPES3D[group.shape] + (open ? "-open" : ""), size = slider ? 10 : open ? 7 : 6;
  const color = slider ? LOOKS.orange : group.joint ? LOOKS.green : group.fill === "grey" ? LOOKS.grey : LOOKS.ink;
  const small = group.names.length > 30 ? 0.5 : 1;
  return {
    still: group.position.count === 1,
    trace: {
      type: "scatter3d", mode: "markers", name: group.kind, text: group.names, hovertemplate: NAMED,
      marker: { symbol, size: small * size, color, opacity: 1 }, x: [], y: [], z: [],
    },
    at(k) {
      const path = new Path(), row = group.position.row(k);
      for (let i = 0; i < row.length; i += 3) path.add(row, i);
      return { ...path };
    },
    pick: (i) => wayOf(group.names[i]),
  };
}

// A shaft and four lines for a head; a row of arrows says the same at each.
function arrowLayer(group, i) {
  const trace = line(group.kind, { width: 4, color: [LOOKS.curves[4], LOOKS.green, LOOKS.blue][i % 3] }, { text: [] });
  return {
    trace,
    at(k) {
      const path = new Path(), text = [], ends = group.ends.row(k), size = group.size.row(k);
      let at = 0;
      group.names.forEach((name, g) => {
        const said = `${name}: ${written(size[g])} ${group.unit}`;
        for (let c = 0; c < group.count[g]; c++, at += 6) {
          for (const [from, to] of strokesOf(ends.subarray(at, at + 3), ends.subarray(at + 3, at + 6), group)) {
            path.add(from); path.add(to); path.gap();
            text.push(said, said, "");
          }
        }
      });
      return { ...path, text };
    },
  };
}

// Normal forces of surfaces along beams, where friction sticks and where it slips.
function combLayer(combs, slipping) {
  const known = combs.some(({ slips }) => slips);
  const name = slipping ? "contact, slips" : known ? "contact, sticks" : "contact forces";
  return {
    trace: line(name, { width: 3, color: slipping ? LOOKS.orange : LOOKS.green }, { text: [] }),
    absent: slipping && !known,
    at(k) {
      const path = new Path(), text = [];
      for (const { name: of, ends, force, slide, slips } of combs) {
        const row = ends.row(k), forces = force.row(k), speeds = slide.row(k), slip = slips?.row(k);
        forces.forEach((size, i) => {
          if (!(size > 0) || Boolean(slip && slip[i] > 0.5) !== slipping) return;
          path.add(row, 6 * i); path.add(row, 6 * i + 3); path.gap();
          const said = `${of}: ${written(size)} N/m, slides at ${written(speeds[i])} m/s`;
          text.push(said, said, "");
        });
      }
      return { ...path, text };
    },
    pick: () => null,
  };
}

// As in scene/arrows.py: straight, or three quarters of a circle about its axis.
function strokesOf(tail, tip, { head, turns }) {
  const add = (a, x, b) => [0, 1, 2].map((d) => a[d] + x * b[d]), unit = (a) => a.map((x) => x / Math.hypot(...a));
  const cross = (a, b) => [0, 1, 2].map((d) => a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3]);
  const whole = add(tip, -1, tail), length = Math.hypot(...whole);
  if (!(length > 0)) return [];
  const axis = unit(whole), sizes = axis.map(Math.abs), least = sizes.indexOf(Math.min(...sizes));
  const first = unit(cross(axis, [0, 1, 2].map((d) => d === least ? 1 : 0))), second = cross(axis, first);
  const path = [tail, tip];
  if (turns) {
    path.length = 0;
    for (let i = 0; i <= 24; i++) {
      const angle = 1.5 * Math.PI * (i / 24 - 1), radius = 0.4 * length;
      path.push(add(add(tail, radius * Math.sin(angle), first), -radius * Math.cos(angle), second));
    }
  }
  const end = path[path.length - 1], back = add(end, -Math.min(head, 0.5 * length), turns ? first : axis);
  const wide = 0.4 * Math.min(head, 0.5 * length);
  const lines = path.slice(1).map((point, i) => [path[i], point]);
  for (const side of turns ? [second, axis] : [first, second]) {
    lines.push([end, add(back, wide, side)], [end, add(back, -wide, side)]);
  }
  return lines;
}

// A ground or the surface of a fluid, which stay but for waves.
function netLayer(net, triads) {
  const look = net.kind === "surface" ? { width: 1, color: LOOKS.curves[0] } : { width: 2, color: LOOKS.grey };
  const drawn = (place) => {
    const path = new Path();
    for (const points of net.lines) {
      for (const point of points) path.add(place(point));
      path.gap();
    }
    return { ...path };
  };
  const more = { hoverinfo: "skip", hovertemplate: null };
  if (net.heights) {
    return {
      trace: line(net.name, look, more),
      at(k) {
        const heights = net.heights.row(k);
        let i = 0;
        return drawn((p) => [p[0], p[1], heights[i++]]);
      },
    };
  }
  if (net.on < 0) {
    return { trace: line(net.name, look, { ...more, ...drawn((point) => point) }), still: true, at: () => ({}) };
  }
  return {
    trace: line(net.name, look, more),
    at(k) {
      const centre = triads.centre.row(k).subarray(3 * net.on, 3 * net.on + 3);
      const axes = triads.axes.row(k).subarray(9 * net.on, 9 * net.on + 9);
      return drawn((p) => [0, 1, 2].map((i) => centre[i] + [0, 1, 2].reduce((s, j) => s + axes[3 * i + j] * p[j], 0)));
    },
  };
}

// The whole path is faint, what was passed is bold.
function traceLayers(trace, i) {
  const run = DATA.runs.findIndex((name) => trace.name.startsWith(`${name}: `)), times = trace.t.values;
  const color = run < 0 ? [LOOKS.orange, LOOKS.green, LOOKS.blue][i % 3] : LOOKS.curves[run];
  const upTo = (last) => {
    const path = new Path();
    for (let k = 0; k <= last; k++) path.add(trace.position.row(k));
    return { ...path };
  };
  const name = `path of ${trace.name}`, more = { hoverinfo: "skip", hovertemplate: null };
  const whole = upTo(times.length - 1);
  return [
    { trace: line(name, { width: 1.5, color: LOOKS.light }, { ...more, ...whole }), still: true,
      at: () => ({}) },
    { trace: line(name, { width: 3, color }, more), at: (k) => upTo(placeAt(times, TIMES[k])) },
  ];
}
