// The legend: a box for each kind of thing, which shows or hides it.

const SHAPES = {
  circle: '<circle cx="6" cy="6" r="4.2"/>',
  diamond: '<path d="M6 1L11 6L6 11L1 6Z"/>',
  square: '<path d="M2 2H10V10H2Z"/>',
  cross: '<path d="M4.5 1H7.5V4.5H11V7.5H7.5V11H4.5V7.5H1V4.5H4.5Z"/>',
};

// Things by name, with the places of their layers.
function groupsOf(layers) {
  const groups = new Map();
  layers.forEach(({ trace, absent }, i) => {
    if (!absent) groups.set(trace.name, [...groups.get(trace.name) ?? [], i]);
  });
  return groups;
}

class Legend {
  constructor(div, picture) {
    this.picture = picture;
    this.bodies = [];
    div.replaceChildren();
    for (const [name, places] of groupsOf(picture.layers)) div.append(this.entry(name, places));
  }

  entry(name, places) {
    const label = document.createElement("label"), box = document.createElement("input");
    Object.assign(box, { type: "checkbox", checked: !this.picture.hidden.has(name) });
    box.addEventListener("change", () => this.picture.toggle(name, places, box.checked));
    label.append(box, this.swatch(this.picture.layers[places[places.length - 1]].trace), name);
    return label;
  }

  swatch({ kind, mode, line, marker, run }) {
    const span = document.createElement("span");
    span.className = "swatch";
    if (kind) this.bodies.push([span, run ?? 0]);
    else if (mode === "markers") span.innerHTML = symbol(marker);
    else span.style.background = band([].concat(line.color).slice(0, 9).filter((_, i) => i % 3 === 0), line.dash);
    return span;
  }

  // Bodies have the colours that they are drawn with.
  recolor(color) {
    const scale = LOOKS.scale.map(([, shade]) => shade);
    for (const [span, run] of this.bodies) {
      span.style.background = color === "plain" ? LOOKS.curves[run] : `linear-gradient(90deg, ${scale.join()})`;
    }
  }
}

function symbol({ symbol: name, color }) {
  const open = name.endsWith("-open"), shape = SHAPES[name.replace("-open", "")];
  return `<svg width="12" height="12" fill="${open ? "none" : color}" stroke="${color}">${shape}</svg>`;
}

// Stripes of some colours, or of one with gaps.
function band(colors, dash) {
  if (dash) return `repeating-linear-gradient(90deg, ${colors[0]} 0 5px, transparent 5px 8px)`;
  const width = 100 / colors.length;
  return `linear-gradient(90deg, ${colors.map((c, i) => `${c} ${i * width}% ${(i + 1) * width}%`).join()})`;
}
