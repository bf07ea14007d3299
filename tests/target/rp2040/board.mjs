// A Pico with a display on it: the emulator, what it lacks, and the loop that lets time pass.

import { createRequire } from 'node:module';
import { join } from 'node:path';

import { BOOT2_AT, boot2Of } from './image.mjs';
import { DisplayBus } from './display_bus.mjs';
import { Problems, Stopped } from './problems.mjs';
import { Silicon } from './silicon.mjs';
import { Trace } from './trace.mjs';
import { Uart } from './uart.mjs';

const RAM = 0x20000000, FLASH = 0x10000000;
const PAINT = 0xa5; // what SRAM holds after power-on is anybody's guess; it is not zero
const ROSC_HZ = 6.5e6; // what the chip runs from until the program starts its clocks
const UART0 = 0x40034;
const UART_PINS = [0, 1], FUNCTION_UART = 2;
const FRAMES_KEPT = 64;

// `modules`: the folder that holds node_modules with rp2040js. `image`: from loadUf2. `stack`: {begin, end} or null.
// `frameAt`: the address of the function that begins a frame, or 0: a frame ends where the next command follows its
// pixels on the wire, which is wrong where frames are sent in pieces, or not at all.
export class Board {
  constructor({ modules, image, tracePath, uartSpeed, stack, frameAt }) {
    const { RP2040 } = createRequire(join(modules, 'package.json'))('rp2040js');
    this.mcu = new RP2040();
    this.clock = this.mcu.clock;
    const { mcu, clock } = this;
    const { core } = mcu;
    this.problems = new Problems(() => ({ pc: core.PC, ns: clock.nanos }));
    this.trace = new Trace(tracePath);
    this.stack = stack;
    this.asleepNs = 0;
    this.frames = [];
    this.frameCount = 0;
    this.frameMark = this.#mark();
    this.bandAsleepNs = [];
    this.bandMarkNs = 0;

    this.uart = new Uart(mcu, clock, this.problems, uartSpeed);
    this.uart.checkPins = () =>
      UART_PINS.every((pin) => mcu.gpio[pin].ctrl === FUNCTION_UART) ? '' : 'GP0 and GP1 are not UART0 (function 2)';
    mcu.peripherals[UART0] = this.uart;
    this.silicon = new Silicon(mcu, clock, this.problems);
    this.display = new DisplayBus(mcu, clock, this.problems, this.trace, () => this.silicon.checkClocks());
    this.display.onBand = () => this.#bandBegins();
    this.frameAt = frameAt;
    if (!frameAt) {
      this.display.onFrameEnd = () => this.#frameEnds();
    }
    this.silicon.watchProcessor(image, this.display);
    this.#untilStopped(() => this.#boot(image));
  }

  // Lets emulated time pass until `untilNs`, a fatal problem, or, if asked for, the end of a picture.
  run(untilNs, stopAtFrameEnd = false) {
    if (!this.problems.fatal) {
      this.#untilStopped(() => this.#run(untilNs, stopAtFrameEnd));
    }
  }

  #untilStopped(work) {
    try {
      work();
    } catch (error) {
      if (!(error instanceof Stopped)) {
        throw error;
      }
    }
  }

  #run(untilNs, stopAtFrameEnd) {
    const { mcu, clock, display } = this;
    const { core } = mcu;
    const frames = display.frameEnds.length;
    while (clock.nanos < untilNs) {
      if (core.waiting) {
        if ((core.pendingInterrupts & core.enabledInterrupts) !== 0 || core.pendingSystick) {
          core.waiting = false;
          continue;
        }
        const room = untilNs - clock.nanos;
        const ns = clock.nextAlarm ? Math.min(clock.nanosToNextAlarm, room) : room;
        this.asleepNs += ns;
        clock.tick(ns);
      } else {
        // Not the instruction's own count alone: the divider adds its cycles to the core's.
        if (core.PC === this.frameAt) {
          this.#frameEnds();
        }
        const before = core.cycles;
        core.executeInstruction();
        clock.tick(((core.cycles - before) * 1e9) / mcu.clkSys);
      }
      if (stopAtFrameEnd && display.frameEnds.length > frames) {
        break;
      }
    }
  }

  get report() {
    const { mcu, clock, display, problems } = this;
    return {
      now_ns: Math.floor(clock.nanos),
      clk_sys_hz: mcu.clkSys,
      clk_peri_hz: mcu.clkPeri,
      pixel_hz: display.pixelHz,
      flash_hz: this.silicon.flashHz,
      uart_baud: this.uart.baud,
      words: display.words,
      stack_bytes: this.#stackBytes(),
      frames: this.frames,
      frame_count: this.frameCount,
      frame_ends: display.frameEnds,
      problems: problems.counts,
      texts: problems.texts,
    };
  }

  #boot(image) {
    const { mcu, clock, silicon, problems } = this;
    const { core } = mcu;
    mcu.flash.set(image.bytes);
    mcu.sram.fill(PAINT);
    mcu.clkSys = ROSC_HZ;
    mcu.clkPeri = 0;
    const { stage, good } = boot2Of(image.bytes);
    if (!good) {
      problems.addFatal('boot2', 'the CRC of the first 256 bytes is wrong: the boot ROM starts its USB drive instead');
    }
    mcu.sram.set(stage, BOOT2_AT - RAM);
    core.VTOR = 0;
    core.SP = BOOT2_AT;
    core.LR = 0;
    core.PC = BOOT2_AT;
    for (let steps = 0; core.PC >= RAM && steps < 10_000; steps++) {
      core.executeInstruction();
      clock.tick(1e9 / mcu.clkSys);
    }
    if (core.PC < FLASH || core.PC >= RAM) {
      problems.addFatal('boot2', 'the second stage does not reach the flash');
    }
    silicon.checkFlashInterface();
    if (core.VTOR !== FLASH + 0x100) {
      problems.add('boot2', `VTOR is ${core.VTOR.toString(16)}, not the vectors behind the second stage`);
    }
  }

  #mark() {
    return { ns: this.clock.nanos, asleep: this.asleepNs, wire: this.display?.wireNs ?? 0, words: this.display?.words ?? 0 };
  }

  // The processor has slept since the last band began: it had drawn the next one before this one's turn came.
  #bandBegins() {
    this.bandAsleepNs.push(this.asleepNs - this.bandMarkNs);
    this.bandMarkNs = this.asleepNs;
  }

  #frameEnds() {
    const begin = this.frameMark;
    const end = (this.frameMark = this.#mark());
    const cycles = (ns) => Math.round((ns * this.mcu.clkSys) / 1e9);
    this.frames.push({
      cycles: cycles(end.ns - begin.ns),
      asleep_cycles: cycles(end.asleep - begin.asleep),
      wire_cycles: cycles(end.wire - begin.wire),
      asleep_cycles_of_bands: this.bandAsleepNs.map(cycles),
      words: this.display.words - begin.words,
    });
    this.bandAsleepNs = [];
    this.frameCount++;
    if (this.frames.length > FRAMES_KEPT) {
      this.frames.shift();
    }
  }

  #stackBytes() {
    if (!this.stack) {
      return 0;
    }
    const { begin, end } = this.stack;
    let lowest = begin;
    while (lowest < end && this.mcu.sram[lowest - RAM] === PAINT) {
      lowest++;
    }
    return end - lowest;
  }
}
