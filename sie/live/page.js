"use strict";
const page = JSON.parse(document.getElementById("page").textContent);
const element = (id) => document.getElementById(id);
const inks = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
const client = Math.random().toString(36).slice(2);
const sources = {}; // by name, a list: each picture has its own
const figures = {};
const REFINED = 4; // pixels of the stress between two of its points
const LEVELS = 1000; // of heights, over that of the frame
const PAUSE = 1000; // ms, after which a movement is a new one
const REST = 150; // ms without a movement, before what takes longest is asked for
let latest = 0;
let limits = null; // of the axes, for one punch
let shown = null; // the last answer, and the settings it belongs to
let moving = { name: "", time: -Infinity }; // the slider that moves

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

// ---- settings ----------------------------------------------------------------------------------

function setting() {
  const values = { shape: element("shape").value };
  for (const control of page.controls) {
    values[control.name] = control.values[element(control.name).value];
  }
  return values;
}

function set(name, value) {
  const control = page.controls.find((c) => c.name === name);
  element(name).value = control.values.indexOf(value);
}

const used = (control, shape) => control.name !== "flat" || shape === "rounded flat";

function nameOf(values) {
  const controls = page.controls.filter((c) => used(c, values.shape));
  return [values.shape, ...controls.map((c) => String(values[c.name]))].join("|");
}

const kept = (values) => !page.answers || nameOf(values) in page.answers;

// Dissimilar bodies with friction: two patches have no answer; partial slip under a tilted punch
// takes more than half a second.
function barred(v) {
  if (v.beta * v.friction === 0) return "";
  if (v.shape === "two parabolas") return "not for two parabolas with friction and β ≠ 0";
  const shifts = v.tilt === 0 || v.shape === "parabola" || Math.abs(v.share) === 1;
  return shifts ? "" : "tilt with β ≠ 0 only where Q = ±f P";
}

// Why a slider cannot move, in words, or "".
function obstacle(name, v) {
  if (name === "share" && v.friction === 0) return "no tangential load without friction";
  const control = page.controls.find((c) => c.name === name);
  if (control.values.length < 2) return `always ${control.values[0]} here`;
  const moved = control.values.filter((value) => value !== v[name]).map((value) => ({ ...v, [name]: value }));
  const bar = barred(v) ? "" : moved.map(barred).find((why) => why) ?? "";
  if (bar) return bar;
  return moved.some(kept) ? "" : "no other value is kept for these settings";
}

function shortened(value) {
  return String(Number(value.toPrecision(4)));
}

function labelControls(values) {
  for (const control of page.controls) {
    const input = element(control.name);
    const why = obstacle(control.name, values);
    const value = shortened(values[control.name]);
    input.disabled = why !== "";
    input.setAttribute("aria-valuetext", value);
    element(control.name + "-value").value = value;
    element(control.name + "-why").textContent = why;
    element(control.name + "-row").hidden = !used(control, values.shape);
  }
}

// A saved page has no answer for some settings: take the nearest value that has one.
function nearestKept(control) {
  const values = setting();
  if (kept(values)) return;
  const from = shown.values[control.name];
  const wanted = values[control.name];
  const has = control.values.filter((value) => kept({ ...values, [control.name]: value }));
  const ahead = has.filter((value) => (value - from) * (wanted - from) > 0);
  const near = (list) => list.sort((a, b) => Math.abs(a - wanted) - Math.abs(b - wanted))[0];
  set(control.name, near(ahead.length ? ahead : has));
}

async function answer(values, part, turn) {
  if (page.answers) return page.answers[nameOf(values)][part];
  const reply = await fetch("answer?" + new URLSearchParams({ ...values, part, client, turn }));
  if (reply.status === 204) return null; // a later setting has taken its place
  if (!reply.ok) throw new Error(await reply.text());
  return reply.json();
}

// ---- pictures ----------------------------------------------------------------------------------

function fill(name, data) {
  for (const source of sources[name]) source.data = data;
}

function setRange(range, start, end) {
  range.setv({ start, end, reset_start: start, reset_end: end });
}

// The axes stay while sliders move, and grow where an answer exceeds them.
function fixAxes(shape, a) {
  if (limits?.shape !== shape) limits = { shape, ...a.frame };
  limits.p = Math.max(limits.p, a.tops[0]);
  limits.q = Math.max(limits.q, a.tops[1]);
  limits.lo = Math.min(limits.lo, a.x[0]);
  limits.hi = Math.max(limits.hi, a.x.at(-1));
  for (const name of ["punch", "pressure", "shear", "stress"]) {
    setRange(figures[name].x_range, limits.lo, limits.hi);
    figures[name].below[0].axis_label = a.axes.x;
  }
  setRange(figures.pressure.y_range, 0, limits.p);
  setRange(figures.shear.y_range, -limits.q, limits.q);
  figures.punch.left[0].axis_label = a.axes.height;
  figures.pressure.left[0].axis_label = a.axes.p;
  figures.shear.left[0].axis_label = a.axes.q;
  figures.stress.left[0].axis_label = a.axes.x.replace("x", "depth y");
  scaleHeights();
}

const ratio = (figure) => (figure.inner_height || 0.5) / (figure.inner_width || 1);

// Depths have the scale of lengths. Heights have one that is a round number times larger.
function scaleHeights() {
  if (!limits) return;
  const span = limits.hi - limits.lo;
  const depth = Math.min(ratio(figures.stress), page.depth) * span;
  setRange(figures.stress.y_range, 0.95 * depth, -0.05 * depth); // a mark may lie on the surface
  const fits = (ratio(figures.punch) * span) / (2.1 * limits.height);
  const decade = 10 ** Math.floor(Math.log10(fits));
  const times = decade * [1, 1.5, 2, 3, 4, 5, 6, 8].findLast((t) => t * decade <= fits * 1.0001);
  const bottom = -0.6 * limits.height;
  setRange(figures.punch.y_range, bottom, bottom + (ratio(figures.punch) * span) / times);
  element("exaggeration").textContent = shortened(times);
}

function drawPunch(a) {
  const heights = (levels) => levels.map((v) => (v / LEVELS) * a.frame.height);
  const deep = -10 * limits.height, high = 30 * limits.height;
  const body = heights(a.body);
  const ends = [a.ground[0], a.ground.at(-1)];
  fill("body", { x: [ends[0], ...a.ground, ends[1]], y: [deep, ...body, deep] });
  const solid = a.ground.map((x, k) => [x, k]).filter(([, k]) => a.punch[k] !== null);
  const punch = heights(solid.map(([, k]) => a.punch[k]));
  const xs = solid.map(([x]) => x);
  fill("punch", { x: [xs[0], ...xs, xs.at(-1)], y: [high, ...punch, high] });
  const color = a.zones.map(([, , kind]) => inks(kind));
  const places = a.zones.map(([lo, hi]) => [lo, ...a.ground.filter((x) => x > lo && x < hi), hi]);
  fill("zones", { xs: places, ys: places.map((xs) => xs.map((x) => between(a.ground, body, x))), color });
  fill("bars", { lo: a.zones.map(([lo]) => lo), hi: a.zones.map(([, hi]) => hi), color });
  drawArrows(a.loads, between(a.ground, body, a.loads.at));
}

// The value at x of the line through points.
function between(xs, ys, x) {
  const k = Math.max(1, xs.findIndex((place) => place >= x));
  return ys[k - 1] + ((ys[k] - ys[k - 1]) * (x - xs[k - 1])) / (xs[k] - xs[k - 1]);
}

function drawArrows(loads, ground) {
  const H = limits.height, half = (limits.hi - limits.lo) / 2, middle = (limits.hi + limits.lo) / 2;
  const largest = Math.max(...page.controls.find((c) => c.name === "load").values);
  const arrows = [];
  const add = (label, x0, y0, x1, y1, angle, x = x0, y = y0) =>
    arrows.push({ label, x0, y0, x1, y1, angle, x, y });
  const across = (label, x0, length, y) =>
    add(label, x0, y, x0 + length, y, length > 0 ? -Math.PI / 2 : Math.PI / 2, x0 + length, y);
  const long = H * (0.15 + (1.5 * loads.P) / largest);
  add("P", loads.at, ground + long, loads.at, ground + 0.06 * H, Math.PI);
  if (loads.Q) across("Q", loads.at, 0.5 * half * loads.Q, ground + 0.1 * H + 0.3 * long);
  if (loads.bulk) {
    for (const side of [-1, 1]) {
      const pull = side * half * 0.25 * loads.bulk;
      const from = middle + side * half * (loads.bulk > 0 ? 0.65 : 0.95);
      across("σ", from, pull, -0.35 * H);
    }
  }
  const columns = Object.keys(arrows[0]).map((key) => [key, arrows.map((arrow) => arrow[key])]);
  fill("arrows", { ...Object.fromEntries(columns), color: arrows.map(() => inks("ink")) });
}

function showContact(values, a) {
  fixAxes(values.shape, a);
  const fp = a.p.map((v) => a.f * v);
  fill("contact", { x: a.x, p: a.p, q: a.q, fp, minus: fp.map((v) => -v) });
  drawPunch(a);
  const curve = a.textbook.n !== undefined;
  element("errors").hidden = !curve;
  const legend = curve ? " Dashed green: the error of this page's answer." : "";
  element("about-errors").textContent = `The textbook's method with n nodes. ${a.textbook.lesson}${legend}`;
  if (curve) {
    const certificate = a.textbook.n.map(() => Math.max(a.certificate, 1e-17));
    fill("errors", { n: a.textbook.n, error: a.textbook.errors, certificate });
  }
  showNumbers(a.numbers);
}

function showNumbers(rows) {
  const body = element("numbers").tBodies[0];
  body.replaceChildren();
  for (const [name, value] of rows) {
    const row = body.insertRow();
    const head = document.createElement("th");
    head.scope = "row";
    head.textContent = name;
    row.append(head);
    row.insertCell().textContent = value;
  }
}

function showStress(a) {
  const none = a.refusal !== undefined;
  element("about-stress").textContent = none
    ? "No Mises stress: the sentence above says why."
    : `${shown.contact.axes.mises} in the body; depth and length to one scale. Red ×: first yield.`;
  fill("weakest", { x: [], y: [] });
  const [source] = sources.levels;
  if (none) {
    source.data = { ...source.data, dw: [0], dh: [0] };
    return;
  }
  limits.mises = Math.max(limits.mises, a.top);
  figures.stress.right[0].color_mapper.high = limits.mises;
  const width = (page.across - 1) * REFINED + 1, height = (page.down - 1) * REFINED + 1;
  const Kind = source.data.levels[0].constructor;
  const levels = new Kind(refined(levelsOf(a.steps), a.top / limits.mises, width, height), [height, width]);
  const { lo, hi } = a.frame;
  const dx = (hi - lo) / (width - 1), dy = (page.depth * (hi - lo)) / (height - 1);
  source.data = { levels: [levels], x: [lo - dx / 2], y: [-dy / 2], dw: [dx * width], dh: [dy * height] };
}

function levelsOf(steps) {
  const levels = Uint8Array.from(atob(steps), (c) => c.charCodeAt(0));
  for (let k = page.across; k < levels.length; k++) levels[k] += levels[k - page.across];
  for (let k = 1; k < levels.length; k++) if (k % page.across) levels[k] += levels[k - 1];
  return levels;
}

// Bilinear between the points.
function refined(levels, scale, width, height) {
  const fine = new Uint8Array(width * height);
  for (let j = 0; j < height; j++) {
    const row = Math.min(Math.floor(j / REFINED), page.down - 2), v = j / REFINED - row;
    for (let i = 0; i < width; i++) {
      const column = Math.min(Math.floor(i / REFINED), page.across - 2), u = i / REFINED - column;
      const k = row * page.across + column, l = k + page.across;
      const upper = levels[k] * (1 - u) + levels[k + 1] * u;
      const lower = levels[l] * (1 - u) + levels[l + 1] * u;
      fine[j * width + i] = Math.min(255, scale * (upper * (1 - v) + lower * v));
    }
  }
  return fine;
}

function showStrength(a, contact) {
  if (a.refusal) return;
  fill("weakest", { x: a.weakest.map((w) => w[0]), y: a.weakest.map((w) => w[1]) });
  showNumbers([...contact.numbers, ...a.numbers]);
}

// The curve before a slider began to move.
function haunt(name, time) {
  if (name === moving.name && time - moving.time < PAUSE) return void (moving.time = time);
  moving = { name, time };
  const old = shown && name !== "shape" ? shown.contact : { x: [], p: [], q: [] };
  fill("ghost", { x: old.x, p: old.p, q: old.q });
}

// ---- the page ----------------------------------------------------------------------------------

async function update() {
  const turn = ++latest;
  const values = setting();
  labelControls(values);
  const status = element("status");
  const say = (sentence) => {
    status.classList.toggle("refusal", sentence !== "");
    status.textContent = sentence;
  };
  element("pictures").classList.add("stale");
  try {
    const contact = await answer(values, "contact", turn);
    if (turn !== latest) return;
    say(contact.refusal || "");
    if (contact.refusal) {
      document.body.dataset.settled = turn;
      return;
    }
    showContact(values, contact);
    shown = { values, contact };
    element("pictures").classList.remove("stale");
    const stress = await answer(values, "stress", turn);
    if (turn !== latest) return;
    showStress({ ...stress, frame: contact.frame });
    await new Promise((resolve) => setTimeout(resolve, REST));
    if (turn !== latest) return;
    const strength = stress.refusal ? stress : await answer(values, "strength", turn);
    if (turn !== latest) return;
    say(strength.refusal || "");
    showStrength(strength, contact);
    document.body.dataset.shown = document.body.dataset.settled = turn;
  } catch (error) {
    if (turn === latest) say("No answer: " + error.message);
  }
}

function colours() {
  const [ink, line, paper] = ["ink", "line", "paper"].map(inks);
  for (const figure of Object.values(figures)) {
    figure.background_fill_color = figure.border_fill_color = paper;
    figure.outline_line_color = line;
    for (const axis of [...figure.below, ...figure.left]) {
      axis.axis_label_text_color = axis.major_label_text_color = ink;
      axis.axis_line_color = axis.major_tick_line_color = axis.minor_tick_line_color = ink;
    }
    for (const grid of figure.center) if ("grid_line_color" in grid) grid.grid_line_color = line;
    for (const bar of figure.right) bar.major_label_text_color = ink;
  }
  if (shown) drawPunch(shown.contact);
}

function addControl(control) {
  const row = document.createElement("div");
  Object.assign(row, { className: "control", id: control.name + "-row" });
  const label = document.createElement("label");
  Object.assign(label, { htmlFor: control.name, textContent: control.label });
  const input = document.createElement("input");
  Object.assign(input, { type: "range", id: control.name, min: 0, max: control.values.length - 1, step: 1 });
  input.value = control.values.indexOf(control.start);
  input.setAttribute("aria-describedby", control.name + "-why");
  const output = document.createElement("output");
  output.id = control.name + "-value";
  const why = document.createElement("p");
  Object.assign(why, { className: "reason", id: control.name + "-why" });
  input.addEventListener("input", (event) => {
    haunt(control.name, event.timeStamp);
    nearestKept(control);
    update();
  });
  row.append(label, input, output, why);
  if (control.more) element("more").lastElementChild.append(row);
  else element("more").before(row);
  if (control.more && control.start) element("more").open = true;
}

function choose(event) {
  haunt("shape", event.timeStamp);
  if (element("shape").value === "two parabolas") set("beta", 0);
  if (barred(setting())) set("tilt", 0);
  for (const name of ["beta", "bulk", "tilt"]) if (!kept(setting())) set(name, 0);
  update();
}

async function start() {
  if (page.packed) {
    const script = document.createElement("script");
    script.textContent = await unpacked(element("bokeh-script").textContent.trim());
    document.head.append(script);
    page.answers = JSON.parse(await unpacked(element("answers").textContent.trim()));
  }
  const zones = "<b class=stick>green: sticks</b>, <b class=slip>orange: slips</b>";
  element("about-punch").innerHTML =
    `Punch and body: heights × <span id="exaggeration"></span>. All deformation is drawn in the body. On the surface, ${zones}, <b class=smooth>blue: no friction</b>.`;
  element("about-shear").innerHTML = `Shear stress q; dashed: ±f p. Bar: ${zones}. Grey: before.`;
  for (const shape of page.shapes) element("shape").add(new Option(shape));
  element("shape").addEventListener("change", choose);
  element("controls").addEventListener("submit", (event) => event.preventDefault());
  page.controls.forEach(addControl);
  for (const [place, item] of Object.entries(page.items)) {
    await Bokeh.embed.embed_item(item, place);
    const [figure] = Bokeh.documents.at(-1).roots();
    figures[place] = figure;
    for (const { data_source: source } of figure.renderers) {
      const known = (sources[source.name] ??= []);
      if (!known.includes(source)) known.push(source);
    }
  }
  for (const name of ["punch", "stress"]) {
    figures[name].properties.inner_width.change.connect(scaleHeights);
  }
  colours();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", colours);
  await update();
}

start();
