// What is wrong, each with a name that tests ask for, and where and when it happened. A run goes on after most
// problems, so that one fault can be seen by several checks; after a fatal one nothing would mean anything any more.

const TEXTS_KEPT = 20;

// Ends the step in which it is thrown.
export class Stopped extends Error {}

export class Problems {
  constructor(where) {
    this.where = where; // () => ({pc, ns})
    this.counts = {};
    this.texts = [];
    this.fatal = false;
  }

  add(kind, text) {
    this.counts[kind] = (this.counts[kind] ?? 0) + 1;
    if (this.texts.length < TEXTS_KEPT && this.counts[kind] <= 4) {
      const { pc, ns } = this.where();
      this.texts.push(`${kind}: ${text} (at ${hex(pc)}, ${(ns / 1e6).toFixed(3)} ms)`);
    }
  }

  addFatal(kind, text) {
    this.add(kind, text);
    this.fatal = true;
    throw new Stopped(text);
  }
}

export function hex(value) {
  return `0x${(value >>> 0).toString(16).padStart(8, '0')}`;
}
