// The player: time, buttons, keys, choices, and what begins everything.

const $ = (name) => document.getElementById(name);
const FACTORS = [-4, -3, -2, -1, 0, 1, 2, 3].flatMap((e) => [1, 2, 5].map((m) => m * 10 ** e));
const LENGTH = 10;  // s that a run takes at the first speed, about

take(JSON.parse(document.getElementById("data").textContent));

const player = { frame: 0, time: TIMES[0], playing: false, drawn: 0, drawing: false };
const hook = window.__ancf = {
  ready: false, errors: [], seek, get frame() { return player.frame; }, get playing() { return player.playing; },
};
window.addEventListener("error", (event) => hook.errors.push(String(event.message)));
window.addEventListener("unhandledrejection", (event) => hook.errors.push(String(event.reason)));

const sources = new Sources();
let picture = null;
let panels = [];

async function begin() {
  setPlayer();
  sources.load();
  beginPlots();
  if (webgl()) {
    picture = new Picture($("stage"));
    picture.load(SCENE, unpacked(DATA.traces));
    choices();
    await picture.start(pick);
  } else {
    const said = "This browser has no WebGL, which the picture in three dimensions needs. Switch on hardware "
      + "acceleration or take another browser.";
    $("stage").append(Object.assign(document.createElement("p"), { className: "message", textContent: said }));
    $("choices").hidden = $("legend").hidden = true;
  }
  for (const panel of panels) await panel.show();
  listen();
  seek(0);
  hook.ready = true;
}

function setPlayer() {
  $("player").hidden = LAST === 0;
  $("keys").hidden = LAST === 0;
  $("time").max = LAST;
  const before = $("speed").value;
  $("speed").replaceChildren();
  fill($("speed"), speeds().map((f) => [String(f), `${f} ×`]), String(firstSpeed()));
  if (speeds().map(String).includes(before)) $("speed").value = before;
}

// Curves over time, and where there is room what goes along the first body.
function beginPlots() {
  const count = Math.min(SLOTS, Math.max(2, Math.floor(window.innerHeight / HEIGHT)));
  const times = sources.names(OVER_TIME), along = sources.names(ALONG);
  const rest = Math.max(count > 2 ? 1 : 0, count - times.length);
  const names = [...times.slice(0, count - Math.min(rest, along.length)), ...along.slice(0, LAST ? Math.min(rest, 1) : 2)];
  panels = names.map((name) => new Panel($("plots"), sources, name, seekTime, pick));
}

// Plots what was clicked, in the last panel but the one that was clicked in.
async function pick(make, from, quantity) {
  const name = sources.pick(make);
  if (!name) return;
  const same = quantity && [...sources.groups.get(sources.get(name).group).values()].find((s) => s.quantity === quantity);
  const others = panels.filter((panel) => panel !== from);
  for (const panel of panels) panel.list();
  await (others[others.length - 1] ?? panels[0])?.choose(same?.name ?? name);
}

// New data: the same page goes on with it. At the last state it follows the run.
async function renew(plain) {
  const last = player.frame === LAST && !player.playing, time = player.time, before = panels.length;
  take(plain);
  setPlayer();
  sources.load();
  if (before) for (const panel of panels) panel.list();
  else beginPlots();
  await picture?.renew(SCENE, unpacked(DATA.traces));
  for (const panel of panels) await panel.show();
  player.drawn = -1;
  if (last) seek(LAST);
  else seekTime(time);
}

function tellStatus({ text, good } = DATA.status) {
  const badge = document.querySelector(".badge");
  badge.textContent = text;
  badge.className = `badge ${good ? "good" : "bad"}`;
  $("foot").textContent = DATA.foot;
}

function fill(select, pairs, chosen) {
  for (const [value, text] of pairs) select.add(new Option(text, value));
  select.value = chosen;
}

// Speeds at which the run takes between a second and ten minutes, and real time.
function speeds() {
  const duration = TIMES[LAST] - TIMES[0];
  return FACTORS.filter((f) => f === 1 || (duration / f >= 1 && duration / f <= 600)).map((f) => Number(f.toPrecision(1)));
}

function firstSpeed() {
  const wanted = (TIMES[LAST] - TIMES[0]) / LENGTH, far = (f) => Math.abs(Math.log(f / wanted));
  return speeds().reduce((best, f) => far(f) < far(best) ? f : best);
}

function choices() {
  const { quantities, strips } = SCENE, aim = targets();
  const first = aim.length && strips?.names.includes(aim[0][0]) ? aim[0] : ["", null];
  fill($("color"), [...quantities.map((q) => [q.name, q.name]), ["plain", DATA.runs.length > 1 ? "runs" : "plain"]], picture.color);
  fill($("camera"), Object.keys(VIEWS).map((name) => [name, name]), picture.view);
  fill($("aspect"), [["equal", "to scale"], ["stretched", "stretched"]], picture.stretched ? "stretched" : "equal");
  fill($("follow"), [["", "nothing"], ...aim.map(([name]) => [name, name])], first[0]);
  $("follow").parentElement.hidden = aim.length === 0;
  picture.followed = first[1];

  $("color").addEventListener("change", (event) => picture.recolor(event.target.value, player.frame));
  $("camera").addEventListener("change", (event) => { picture.view = event.target.value; relayout(true); });
  $("aspect").addEventListener("change", (event) => { picture.stretched = event.target.value === "stretched"; relayout(); });
  $("follow").addEventListener("change", (event) => {
    picture.followed = new Map(aim).get(event.target.value) ?? null;
    relayout();
  });
}

function relayout(camera = false) {
  return picture.relayout(player.frame, camera);
}

// What a window can follow: strips, masses and rigid bodies that move far.
function targets() {
  const found = [], { strips, markers } = SCENE;
  const middle = (row, i) => [0, 1, 2].map((d) => (row[6 * i + d] + row[6 * i + 3 + d]) / 2);
  const far = (at) => Math.abs(at(LAST)[picture.long] - at(0)[picture.long]) > 0.1 * picture.size;
  strips?.names.forEach((name, i) => {
    const at = (k) => middle(strips.ends.row(k), i);
    if (LAST === 0 || far(at)) found.push([name, at]);
  });
  for (const { kind, names, position } of markers) {
    if (!["point mass", "rigid body"].includes(kind) || position.count === 1) continue;
    names.forEach((name, i) => {
      const at = (k) => position.row(k).subarray(3 * i, 3 * i + 3);
      if (far(at)) found.push([name, at]);
    });
  }
  return found;
}

function listen() {
  $("play").addEventListener("click", () => play(!player.playing));
  $("back").addEventListener("click", () => step(-1));
  $("ahead").addEventListener("click", () => step(1));
  $("time").addEventListener("input", (event) => seek(Number(event.target.value)));
  document.addEventListener("keydown", onKey);
  $("save").addEventListener("click", () => savePicture(picture.div, `${document.title}, t = ${written(TIMES[player.frame])} s`, `t ${written(TIMES[player.frame])} s`));
  NIGHT.addEventListener("change", async () => {
    dress();
    await picture?.renew(SCENE, unpacked(DATA.traces));
    for (const panel of panels) await panel.show();
  });
  play(false);
}

function onKey(event) {
  if (LAST === 0 || ["SELECT", "BUTTON"].includes(event.target.tagName) && event.key === " " || event.target.tagName === "SELECT" || event.ctrlKey || event.metaKey || event.altKey) return;
  const stride = event.shiftKey ? 10 : 1;
  const action = {
    " ": () => play(!player.playing), ArrowLeft: () => step(-stride), ArrowRight: () => step(stride),
    Home: () => seek(0), End: () => seek(LAST),
  }[event.key];
  if (!action) return;
  event.preventDefault();
  action();
}

function step(by) {
  play(false);
  seek(Math.min(Math.max(player.frame + by, 0), LAST));
}

function seek(k) {
  player.time = TIMES[k];
  show(k);
}

function seekTime(t) {
  player.time = Math.min(Math.max(t, TIMES[0]), TIMES[LAST]);
  show(placeAt(TIMES, player.time));
}

function play(on) {
  if (on && player.time >= TIMES[LAST]) player.time = TIMES[0];
  player.playing = on && LAST > 0;
  $("play").textContent = player.playing ? "❚❚" : "▶";
  $("play").ariaLabel = player.playing ? "pause" : "play";
  if (player.playing) requestAnimationFrame((now) => tick(now, now));
}

function tick(now, before) {
  if (!player.playing) return;
  player.time += (now - before) / 1000 * Number($("speed").value);
  if (player.time > TIMES[LAST]) {
    player.time = $("loop").checked ? TIMES[0] : TIMES[LAST];
    if (!$("loop").checked) play(false);
  }
  show(placeAt(TIMES, player.time));
  requestAnimationFrame((next) => tick(next, now));
}

// State k: the slider, the words and the plots at once, the picture as soon as it can.
function show(k) {
  player.frame = k;
  $("time").value = k;
  $("now").textContent = `t = ${TIMES[k].toFixed(digits())} s${forces(k)}`;
  for (const panel of panels) panel.move(TIMES[k]);
  drawLast();
}

// Draws the present state; states that pass while it draws are left out.
async function drawLast() {
  if (!picture || player.drawing) return;
  player.drawing = true;
  while (player.drawn !== player.frame) {
    const k = player.frame;
    if (await picture.draw(k)) player.drawn = k;
    await new Promise((later) => setTimeout(later, 10));  // for keys and the mouse
  }
  player.drawing = false;
}

// Decimals that tell neighbouring states apart.
function digits() {
  const between = (TIMES[LAST] - TIMES[0]) / Math.max(LAST, 1);
  return between > 0 ? Math.min(Math.max(0, 1 - Math.floor(Math.log10(between))), 9) : 3;
}

function forces(k) {
  const { strips } = SCENE;
  if (!strips || !Number.isFinite(strips.force.row(k)[0])) return "";
  return ", contact " + Array.from(strips.force.row(k), (f) => `${Math.round(f)} N`).join(", ");
}
