// What the chip does and the emulator does not: peripherals that stay in reset until they are released, oscillators and
// a timer that run only when they were started, memory that is not mapped, or not aligned, or erased.
//
// Register and bit numbers: RP2040 data sheet, 2.14 (resets), 2.15 (clocks), 2.16 (XOSC), 2.18 (PLL), 4.7 (watchdog).

import { hex } from './problems.mjs';

const RESET_BITS = {
  0x40000: 19, 0x40004: 18, 0x40014: 5, 0x40018: 6, 0x4001c: 8, 0x40020: 9, 0x40028: 12, 0x4002c: 13, 0x40030: 1,
  0x40034: 22, 0x40038: 23, 0x4003c: 16, 0x40040: 17, 0x40044: 3, 0x40048: 4, 0x4004c: 0, 0x40050: 14, 0x40054: 21,
  0x4005c: 15, 0x4006c: 20, 0x50000: 2, 0x50110: 24, 0x50200: 10, 0x50300: 11,
};
const ALL_RESETS = 0x1ffffff;
const RELEASED_BY_BOOT_ROM = (1 << 6) | (1 << 9); // the flash's pins and pads
const RESET_TAKES_NS = 200; // a few cycles of the slowest clock

const RESETS = 0x4000c, TIMER = 0x40054, WATCHDOG = 0x40058, ROSC = 0x40060, SSI = 0x18000, XOSC = 0x40024;
const WATCHDOG_TICK = 0x2c, TICK_ENABLED = 1 << 9, TICK_CYCLES = 0x1ff;
const ROSC_STATUS = 0x18, ROSC_RANDOM = 0x1c, ROSC_STABLE = (1 << 31) | (1 << 12);

const FLASH = 0x10000000, FLASH_WINDOW_END = 0x14000000, RAM = 0x20000000, RAM_END = 0x20042000;

// Each register has aliases that set it, flip, set and clear bits of it (2.1.2).
export const writeAlias = (old, value, kind) => [value, old ^ value, old | value, old & ~value][kind] >>> 0;

export class Silicon {
  constructor(mcu, clock, problems) {
    this.mcu = mcu;
    this.clock = clock;
    this.problems = problems;
    this.inReset = ALL_RESETS & ~RELEASED_BY_BOOT_ROM;
    this.releasedAt = new Array(25).fill(-Infinity);
    this.tick = 0;
    this.imageEnd = 0;
    this.flashHz = 0;
    this.random = 0x2545f491;
    mcu.peripherals[RESETS] = this.#resets();
    mcu.peripherals[ROSC] = this.#rosc();
    this.#watchWatchdog();
    for (const [key, bit] of Object.entries(RESET_BITS)) {
      this.#guard(mcu.peripherals[key], () => this.#checkReset(Number(key), bit));
    }
    this.#guard(mcu.peripherals[TIMER], () => this.#checkTick());
    mcu.logger = {
      debug() {},
      info() {},
      warn: (from, text) => this.#warned(from, text),
      error: (from, text) => this.#warned(from, text),
    };
    console.warn = console.error = (text) => this.#warned('emulator', text);
    mcu.onBreak = (code) => problems.addFatal('breakpoint', `bkpt ${code}`);
    const watchdog = mcu.peripherals[WATCHDOG];
    watchdog.onWatchdogTrigger = () =>
      problems.addFatal('restart', watchdog.reason === 1 ? 'the watchdog bit' : 'the program restarts the chip');
  }

  // Looks at each access of the processor; the DMA and the exception entry go past this.
  watchProcessor(image, display) {
    const { mcu } = this;
    const { core } = mcu;
    this.imageEnd = FLASH + image.end;
    const ram = mcu.sram, ram16 = new Uint16Array(ram.buffer), ram32 = new Uint32Array(ram.buffer);
    const { flash } = mcu;
    const flash16 = new Uint16Array(flash.buffer), flash32 = new Uint32Array(flash.buffer);
    const { imageEnd } = this;
    core.readUint8 = (address) => {
      address >>>= 0;
      if (address >= RAM && address < RAM_END) return ram[address - RAM];
      if (address >= FLASH && address < imageEnd) return flash[address - FLASH];
      this.#checkRead(address, 1);
      return mcu.readUint8(address);
    };
    core.readUint16 = (address) => {
      address >>>= 0;
      if ((address & 1) === 0) {
        if (address >= RAM && address < RAM_END) return ram16[(address - RAM) >> 1];
        if (address >= FLASH && address < imageEnd) return flash16[(address - FLASH) >> 1];
      }
      this.#checkRead(address, 2);
      return mcu.readUint16(address);
    };
    core.readUint32 = (address) => {
      address >>>= 0;
      if ((address & 3) === 0) {
        if (address >= RAM && address < RAM_END) return ram32[(address - RAM) >> 2];
        if (address >= FLASH && address < imageEnd) return flash32[(address - FLASH) >> 2];
      }
      this.#checkRead(address, 4);
      return mcu.readUint32(address & ~3);
    };
    const watched = (bytes, write) => (address, value) => {
      address >>>= 0;
      this.#checkWrite(address, bytes);
      display.checkStore(address, bytes);
      display.storeBytes = bytes;
      write.call(mcu, address, value);
      display.storeBytes = 0;
    };
    core.writeUint8 = watched(1, mcu.writeUint8);
    core.writeUint16 = watched(2, mcu.writeUint16);
    core.writeUint32 = watched(4, mcu.writeUint32);
    // Wakes a sleeping processor also when interrupts are masked, but does not enter the handler then (Armv6-M
    // Architecture Reference Manual, WFI).
    core.setInterrupt = (irq, level) => {
      if (level) {
        core.pendingInterrupts |= 1 << irq;
        core.interruptsUpdated = true;
      } else {
        core.pendingInterrupts &= ~(1 << irq);
      }
    };
  }

  // The clocks that the project promises, computed from the registers.
  checkClocks() {
    const { mcu, problems } = this;
    const xosc = mcu.peripherals[XOSC];
    if (mcu.clkSys !== 125e6 || mcu.clkPeri !== 125e6) {
      problems.add('clock', `clk_sys ${mcu.clkSys / 1e6} MHz, clk_peri ${mcu.clkPeri / 1e6} MHz: both should be 125`);
    }
    // W25Q16JV data sheet, 9.6: read (03h) to 50 MHz, with four lines to 133.
    const ssi = mcu.peripherals[SSI];
    const fastest = ((ssi.crtlr0 >> 21) & 3) === 2 ? 133e6 : 50e6;
    this.flashHz = mcu.clkSys / (ssi.baudr || Infinity);
    if (!(this.flashHz > 0 && this.flashHz <= fastest)) {
      problems.add('clock', `the flash is read at ${this.flashHz / 1e6} MHz, over its ${fastest / 1e6}`);
    }
    const pll = mcu.pllSys;
    const vco = (mcu.xoscFreq / (pll.refdiv || 1)) * pll.fbdiv;
    if (vco < 750e6 || vco > 1600e6 || (pll.pwr & 0x29) !== 0) {
      problems.add('clock', `PLL_SYS: VCO at ${vco / 1e6} MHz (750..1600), PWR ${hex(pll.pwr)}`);
    }
    if (!xosc.enabled || (xosc.ctrl & 0xfff) !== 0xaa0 || !(xosc.startup > 0)) {
      problems.add('clock', 'XOSC: not enabled, not in the range 1..15 MHz, or without a start-up delay');
    }
  }

  #warned(from, text) {
    const undefined_ = /not implemented yet|Opcode/.test(text);
    if (undefined_) {
      this.problems.addFatal('undefined-instruction', text);
    } else {
      this.problems.add('emulator-warning', `${from}: ${text}`);
    }
  }

  #guard(peripheral, check) {
    const read = peripheral.readUint32.bind(peripheral);
    const write = peripheral.writeUint32Atomic.bind(peripheral);
    peripheral.readUint32 = (offset) => (check(), read(offset));
    peripheral.writeUint32Atomic = (offset, value, kind) => (check(), write(offset, value, kind));
  }

  #resets() {
    const released = () => {
      let done = 0;
      for (let bit = 0; bit < 25; bit++) {
        if (this.#isReleased(bit)) {
          done |= 1 << bit;
        }
      }
      return done >>> 0;
    };
    return {
      readUint32: (offset) => (offset === 0 ? this.inReset : offset === 8 ? released() : 0),
      writeUint32Atomic: (offset, value, kind) => {
        if (offset !== 0) {
          return;
        }
        const before = this.inReset;
        this.inReset = writeAlias(before, value, kind) & ALL_RESETS;
        for (let bit = 0; bit < 25; bit++) {
          if (before & ~this.inReset & (1 << bit)) {
            this.releasedAt[bit] = this.clock.nanos + RESET_TAKES_NS;
          }
        }
      },
    };
  }

  #isReleased(bit) {
    return (this.inReset & (1 << bit)) === 0 && this.clock.nanos >= this.releasedAt[bit];
  }

  #checkReset(key, bit) {
    if (!this.#isReleased(bit)) {
      const what = `the peripheral at ${hex(key * 0x1000)} (RESETS bit ${bit})`;
      this.problems.add('in-reset', `${what} was used before it was out of reset`);
    }
  }

  // The ring oscillator: a bit of noise is all that firmware has of it.
  #rosc() {
    return {
      readUint32: (offset) => {
        if (offset === ROSC_RANDOM) {
          this.random ^= this.random << 13;
          this.random ^= this.random >>> 17;
          this.random ^= this.random << 5;
          return this.random & 1;
        }
        return offset === ROSC_STATUS ? ROSC_STABLE : 0;
      },
      writeUint32Atomic: () => this.problems.add('emulator-warning', 'ROSC was written, which is not modelled'),
    };
  }

  #watchWatchdog() {
    const watchdog = this.mcu.peripherals[WATCHDOG];
    const write = watchdog.writeUint32Atomic.bind(watchdog);
    watchdog.writeUint32Atomic = (offset, value, kind) => {
      if (offset === WATCHDOG_TICK) {
        this.tick = writeAlias(this.tick, value, kind);
      }
      write(offset, value, kind);
    };
  }

  #checkTick() {
    const cycles = this.tick & TICK_CYCLES;
    if ((this.tick & TICK_ENABLED) === 0 || cycles !== this.mcu.clocks.refFreq / 1e6) {
      this.problems.add('clock', `the timer was used without the watchdog's tick at 1 MHz (TICK ${hex(this.tick)})`);
    }
  }

  #checkRead(address, bytes) {
    address >>>= 0;
    if (address & (bytes - 1)) {
      this.problems.addFatal('unaligned', `${bytes} bytes read at ${hex(address)}`);
    } else if (address < FLASH) {
      this.problems.addFatal('unmapped', `read at ${hex(address)}: no code or data is there`);
    } else if (address >= this.imageEnd && address < FLASH_WINDOW_END) {
      this.problems.addFatal('erased-flash', `read at ${hex(address)}, beyond the image's end ${hex(this.imageEnd)}`);
    } else if (address >= RAM_END && address < 0x40000000) {
      this.problems.addFatal('unmapped', `read at ${hex(address)}, beyond the SRAM's end`);
    }
  }

  #checkWrite(address, bytes) {
    if (address >= RAM && address < RAM_END) {
      if (address & (bytes - 1)) {
        this.problems.addFatal('unaligned', `${bytes} bytes written at ${hex(address)}`);
      }
      return;
    }
    if (address & (bytes - 1)) {
      this.problems.addFatal('unaligned', `${bytes} bytes written at ${hex(address)}`);
    } else if (address >= FLASH && address < FLASH_WINDOW_END) {
      this.problems.addFatal('flash-write', `a store to ${hex(address)}`);
    } else if (address < RAM && address >>> 12 !== SSI) {
      this.problems.addFatal('unmapped', `a store to ${hex(address)}`);
    } else if (address < 0x40000000 && address >>> 12 !== SSI) {
      this.problems.addFatal('unmapped', `a store to ${hex(address)}, beyond the SRAM's end`);
    }
  }

  // Before the first instruction out of flash: boot2 has set the SSI up for reads that this flash understands.
  checkFlashInterface() {
    const ssi = this.mcu.peripherals[SSI];
    if (ssi.ssienr !== 1 || ssi.baudr < 2 || ssi.baudr & 1) {
      this.problems.add('boot2', `SSI enable ${ssi.ssienr}, divisor ${ssi.baudr}: flash cannot be read`);
    }
  }
}

