"use strict";
const page = JSON.parse(document.getElementById("page").textContent);
const element = (id) => document.getElementById(id);
const sources = {}; // by name, a list: each picture has its own
const figures = [];
let latest = 0;

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

function setting() {
  const values = { shape: element("shape").value };
  for (const control of page.controls) {
    values[control.name] = control.values[element(control.name).value];
  }
  return values;
}

async function answer(values, part) {
  if (!page.answers) {
    const reply = await fetch("answer?" + new URLSearchParams({ ...values, part }));
    if (!reply.ok) throw new Error(await reply.text());
    return reply.json();
  }
  const used = page.controls.filter((c) => c.name !== "ratio" || values.shape === "rounded flat");
  return page.answers[[values.shape, ...used.map((c) => String(values[c.name]))].join("|")][part];
}

function shortened(value) {
  return String(Number(value.toPrecision(4)));
}

function fill(name, data) {
  for (const source of sources[name]) source.data = data;
}

function showNumbers(parts) {
  const body = element("numbers").tBodies[0];
  body.replaceChildren();
  for (const [name, value] of parts.flat()) {
    const row = body.insertRow();
    const head = document.createElement("th");
    head.scope = "row";
    head.textContent = name;
    row.append(head);
    row.insertCell().textContent = value;
  }
}

function showContact(a) {
  fill("contact", { x: a.x, p: a.p, q: a.q, fp: a.fp, minus: a.fp.map((v) => -v) });
  const [p, q] = a.tops; // beyond them a curve goes to infinity
  for (const [figure, start, end] of [[figures[0], 0, p], [figures[1], -q, q]]) {
    figure.y_range.setv({ start, end, reset_start: start, reset_end: end });
  }
  fill("stick", { lo: a.stick.map((z) => z[0]), hi: a.stick.map((z) => z[1]) });
  fill("errors", { n: a.n, error: a.errors, certificate: a.n.map(() => Math.max(a.certificate, 1e-17)) });
  showNumbers([a.numbers]);
}

function stressTitle(text) {
  figures.map((figure) => figure.title).find((t) => t.text.startsWith("Mises")).text = text;
}

function hideStress() {
  for (const source of sources.bands) {
    source.data.dw[0] = source.data.dh[0] = 0;
    source.change.emit();
  }
  stressTitle("No Mises stress: the sentence above says why");
  fill("weakest", { x: [], y: [] });
}

function showStress(a, contact) {
  const [lo, hi, depth] = a.frame;
  for (const source of sources.bands) {
    source.data.bands[0].set(a.bands);
    Object.assign(source.data, { x: [lo], y: [0], dw: [hi - lo], dh: [depth] });
    source.change.emit();
  }
  stressTitle(`Mises stress, 0 to ${a.top.toPrecision(3)}; ×: first yield`);
  fill("weakest", { x: a.weakest.map((w) => w[0]), y: a.weakest.map((w) => w[1]) });
  showNumbers([contact.numbers, a.numbers]);
}

async function update() {
  const turn = ++latest;
  const values = setting();
  element("ratio").disabled = values.shape !== "rounded flat";
  for (const control of page.controls) {
    element(control.name).nextElementSibling.value = shortened(values[control.name]);
  }
  const status = element("status");
  for (const id of ["pictures", "numbers"]) element(id).classList.add("stale");
  try {
    const contact = await answer(values, "contact");
    if (turn !== latest) return;
    status.classList.toggle("refusal", "refusal" in contact);
    status.textContent = contact.refusal || "";
    if (contact.refusal) {
      document.body.dataset.settled = turn;
      return;
    }
    showContact(contact);
    for (const id of ["pictures", "numbers"]) element(id).classList.remove("stale");
    const stress = await answer(values, "stress");
    if (turn !== latest) return;
    status.textContent = stress.refusal || "";
    if (stress.refusal) hideStress();
    else showStress(stress, contact);
    document.body.dataset.shown = document.body.dataset.settled = turn;
  } catch (error) {
    status.classList.add("refusal");
    status.textContent = "No answer: " + error.message;
  }
}

function colours() {
  const style = getComputedStyle(document.documentElement);
  const [ink, line, paper] = ["--ink", "--line", "--paper"].map((v) => style.getPropertyValue(v).trim());
  for (const figure of figures) {
    figure.background_fill_color = figure.border_fill_color = paper;
    figure.outline_line_color = line;
    figure.title.text_color = ink;
    for (const axis of [...figure.below, ...figure.left]) {
      axis.axis_label_text_color = axis.major_label_text_color = ink;
      axis.axis_line_color = axis.major_tick_line_color = axis.minor_tick_line_color = ink;
    }
    for (const grid of figure.center) {
      if ("grid_line_color" in grid) grid.grid_line_color = line;
      if ("label_text_color" in grid) {
        grid.label_text_color = ink;
        grid.background_fill_color = paper;
      }
    }
  }
}

function addControl(control) {
  const label = document.createElement("label");
  label.htmlFor = control.name;
  label.textContent = control.label;
  const input = document.createElement("input");
  Object.assign(input, { type: "range", id: control.name, min: 0, max: control.values.length - 1, step: 1 });
  input.value = control.values.indexOf(control.start);
  input.disabled = control.values.length < 2;
  input.addEventListener("input", () => {
    input.setAttribute("aria-valuetext", shortened(control.values[input.value]));
    update();
  });
  element("controls").append(label, input, document.createElement("output"));
}

async function start() {
  if (page.packed) {
    const script = document.createElement("script");
    script.textContent = await unpacked(element("bokeh-script").textContent.trim());
    document.head.append(script);
    page.answers = JSON.parse(await unpacked(element("answers").textContent.trim()));
  }
  for (const shape of page.shapes) element("shape").add(new Option(shape));
  element("shape").addEventListener("change", update);
  element("controls").addEventListener("submit", (event) => event.preventDefault());
  page.controls.forEach(addControl);
  for (const [place, item] of Object.entries(page.items)) {
    await Bokeh.embed.embed_item(item, place);
    const [figure] = Bokeh.documents.at(-1).roots();
    figures.push(figure);
    for (const { data_source: source } of figure.renderers) {
      const known = (sources[source.name] ??= []);
      if (!known.includes(source)) known.push(source);
    }
  }
  colours();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", colours);
  await update();
}

start();
