"use strict";
// The data of the page: names as JSON, all numbers in one text of base64.

let DATA, SCENE, BYTES, TIMES, LAST;

// What the page shows from now on.
function take(plain) {
  DATA = plain;
  BYTES = Uint8Array.from(atob(plain.numbers), (c) => c.charCodeAt(0)).buffer;
  SCENE = unpacked(plain.scene);
  SCENE.threads.forEach((thread, i) => { [thread.run, thread.body] = plain.owners[i]; });
  TIMES = SCENE.t.values;
  LAST = TIMES.length - 1;
  dress();
}

// An array with time first. What is at rest has a single row.
class Rows {
  constructor(plain) {
    const [count, ...rest] = plain.shape;
    this.count = count;
    this.shape = rest;
    this.width = rest.reduce((a, b) => a * b, 1);
    this.values = decoded(plain, count * this.width);
  }

  row(k) {
    const first = Math.min(k, this.count - 1) * this.width;
    return this.values.subarray(first, first + this.width);
  }
}

function decoded(plain, size) {
  if (plain.kind === "f4") return new Float32Array(BYTES, plain.at, size);
  const step = (plain.high - plain.low) / 65535;
  return Float32Array.from(new Uint16Array(BYTES, plain.at, size), (share) => plain.low + step * share);
}

// Every array of an object, in place of its description.
function unpacked(plain) {
  if (plain === null || typeof plain !== "object") return plain;
  if ("at" in plain && "kind" in plain) return new Rows(plain);
  if (Array.isArray(plain)) return plain.map(unpacked);
  return Object.fromEntries(Object.entries(plain).map(([key, value]) => [key, unpacked(value)]));
}

// The last place whose time is not after t.
function placeAt(times, t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle; else high = middle - 1;
  }
  return low;
}

// A number as an engineer writes it.
function written(value, digits = 4) {
  if (!Number.isFinite(value)) return "unknown";
  if (value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6)) return value.toExponential(digits - 2);
  return String(Number(value.toPrecision(digits)));
}
