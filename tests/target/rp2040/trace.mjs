// The wire trace that `edgeline-sim look` reads: "HOT1", then records of two bytes {kind, value}. Kinds: 0 a byte with
// D/C low, 1 a byte with D/C high, 2 the reset line's level, 3 time passes: a little-endian u32 of nanoseconds follows.

import { openSync, writeSync, closeSync } from 'node:fs';

const COMMAND = 0, DATA = 1, RESET = 2, TIME = 3;
const FLUSH_AT = 1 << 16;
// Between two data bytes time is told in steps of 10 us, before anything else to the nanosecond.
const DATA_STEP_NS = 10_000;
const MOST_NS = 0xffffffff;

export class Trace {
  constructor(path) {
    this.file = openSync(path, 'w');
    this.buffer = Buffer.alloc(FLUSH_AT + 64);
    this.buffer.write('HOT1', 'latin1');
    this.used = 4;
    this.written = 0;
    this.told = 0;
  }

  get length() {
    return this.written + this.used;
  }

  reset(level, now) {
    this.#time(now, 0);
    this.#record(RESET, level);
  }

  byte(data, value, now) {
    this.#time(now, data ? DATA_STEP_NS : 0);
    this.#record(data ? DATA : COMMAND, value);
  }

  flush() {
    writeSync(this.file, this.buffer, 0, this.used);
    this.written += this.used;
    this.used = 0;
  }

  close() {
    this.flush();
    closeSync(this.file);
  }

  #record(kind, value) {
    this.buffer[this.used++] = kind;
    this.buffer[this.used++] = value;
    if (this.used >= FLUSH_AT) {
      this.flush();
    }
  }

  #time(now, step) {
    let passed = Math.floor(now - this.told);
    if (passed <= step) {
      return;
    }
    this.told += passed;
    for (; passed > 0; passed -= Math.min(passed, MOST_NS)) {
      this.#record(TIME, 0);
      this.buffer.writeUInt32LE(Math.min(passed, MOST_NS), this.used);
      this.used += 4;
    }
  }
}
