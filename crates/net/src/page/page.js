"use strict";

// Seconds between two looks at how things stand.
const PERIOD = 2;

const by = (id) => document.getElementById(id);

function number(value) {
  if (value === null) return "–";
  for (const [size, unit] of [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"]]) {
    if (value >= size) return (value / size).toPrecision(3) + " " + unit;
  }
  return value >= 100 || Number.isInteger(value) ? value.toFixed(0) : value.toFixed(1);
}

function bytes(value) {
  for (const [size, unit] of [[2 ** 40, "TiB"], [2 ** 30, "GiB"], [2 ** 20, "MiB"], [2 ** 10, "KiB"]]) {
    if (value >= size) return (value / size).toPrecision(3) + " " + unit;
  }
  return value + " B";
}

function time(seconds) {
  const s = Math.floor(seconds);
  const two = (n) => String(n).padStart(2, "0");
  const [hours, minutes] = [Math.floor(s / 3600), Math.floor(s / 60) % 60];
  if (hours >= 48) return Math.floor(hours / 24) + " d " + (hours % 24) + " h";
  return hours ? hours + ":" + two(minutes) + ":" + two(s % 60) : minutes + ":" + two(s % 60);
}

function ago(seconds) {
  if (seconds === null) return "–";
  return seconds < 60 ? Math.round(seconds) + " s ago" : time(seconds) + " ago";
}

function cell(row, text, kind) {
  const td = row.insertCell();
  td.textContent = text;
  if (kind) td.className = kind;
  return td;
}

// A machine in the table: its name, and below that what else there is to say.
function showMachine(body, machine, most) {
  const row = body.insertRow();
  const isThere = !isGone(machine);
  row.className = isThere ? machine.state : "gone " + machine.state;
  const name = cell(row, machine.name, "name");
  for (const [text, kind] of [[machine.address, "below"], [machine.last_error, "below bad"]]) {
    if (!text) continue;
    const line = document.createElement("span");
    line.className = kind;
    line.textContent = text;
    name.append(line);
  }
  cell(row, machine.state, "state");
  cell(row, machine.threads, "number spare");
  const share = cell(row, "", "share");
  if (isThere) {
    const box = document.createElement("div");
    const bar = document.createElement("progress");
    bar.max = Math.max(most, 1e-9);
    bar.value = machine.samples_per_second || 0;
    bar.setAttribute("aria-hidden", "true");
    const text = document.createElement("span");
    text.textContent = number(machine.samples_per_second);
    box.append(bar, text);
    share.append(box);
  }
  cell(row, number(machine.samples), "number spare");
  cell(row, ago(machine.last_upload_s), "number spare");
  cell(row, machine.errors, machine.errors ? "number spare bad" : "number spare");
}

function isGone(machine) {
  return machine.state === "left" || machine.state === "lost";
}

// All machines: a working master first, and those that are gone last.
function machines(status) {
  const own = status.own
    ? [{ name: "The master itself", state: "rendering", samples: null, last_upload_s: null, errors: 0, ...status.own }]
    : [];
  const gone = status.slaves.filter(isGone).slice(-20);
  return [...own, ...status.slaves.filter((slave) => !isGone(slave)), ...gone];
}

function show(status) {
  by("scene").textContent = status.scene;
  document.title = number(status.samples_per_pixel) + " spp – " + status.scene;
  by("spp").textContent = number(status.samples_per_pixel);
  by("rate").textContent = number(status.samples_per_second);
  by("machines").textContent = status.present + (status.own ? 1 : 0);
  by("elapsed").textContent = time(status.elapsed_s);
  by("rendered").textContent = time(status.rendered_s);
  by("received").textContent = bytes(status.bytes_received);
  by("refused").textContent = status.refused;
  const all = machines(status);
  const body = document.createElement("tbody");
  body.id = "slaves";
  const most = Math.max(0, ...all.map((machine) => machine.samples_per_second || 0));
  for (const machine of all) showMachine(body, machine, most);
  by("slaves").replaceWith(body);
  by("table").hidden = all.length === 0;
  by("nobody").hidden = status.slaves.length > 0;
  showPicture(status);
}

// The next picture takes the last one's place when it is there as a whole.
let shown = 0;
function showPicture(status) {
  if (!status.picture || status.picture === shown) return;
  const version = status.picture;
  const next = new Image();
  next.onload = () => {
    shown = version;
    const picture = by("picture");
    picture.src = next.src;
    picture.hidden = false;
    by("caption").textContent =
      status.width + " × " + status.height + ", saved at " + new Date(version).toLocaleTimeString();
  };
  next.src = "/picture.png?" + version;
}

async function look() {
  const state = by("state");
  try {
    const answer = await fetch("/status.json", { signal: AbortSignal.timeout(5000) });
    show(await answer.json());
    state.textContent = "live";
    state.className = "";
  } catch {
    state.textContent = "the master does not answer";
    state.className = "away";
  }
  setTimeout(look, PERIOD * 1000);
}

look();
