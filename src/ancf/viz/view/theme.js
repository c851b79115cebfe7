// Colours of a light and of a dark screen; the same for text and lines of all plots.

const FONT = { family: 'system-ui, "Segoe UI", "DejaVu Sans", sans-serif', size: 12, color: "" };
const NIGHT = window.matchMedia("(prefers-color-scheme: dark)");
let LOOKS;

function dress() {
  LOOKS = DATA.looks[NIGHT.matches ? "dark" : "light"];
  FONT.color = LOOKS.ink;
}

// A colour that one sees through.
function faint(color, share = 0.22) {
  const [r, g, b] = [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
  return `rgba(${r}, ${g}, ${b}, ${share})`;
}
