// UART0 as silicon has it: an Arm PL011 with two FIFOs of 32 bytes and times on the line (Arm DDI 0183, chapter 3;
// RP2040 data sheet, 4.2). The emulator's own sends at once, never fills, and raises its interrupts by level; firmware
// that loses bytes or waits for an interrupt that never comes would pass there.
//
// The line can be told to take nothing (`holdTx`), and to run faster than its baud rate towards the host (`speed`), so
// that a picture need not take seconds: the firmware sees no more of that than a FIFO that empties sooner.

import { writeAlias } from './silicon.mjs';

const DR = 0x00, RSR = 0x04, FR = 0x18, IBRD = 0x24, FBRD = 0x28, LCR_H = 0x2c, CR = 0x30, IFLS = 0x34;
const IMSC = 0x38, RIS = 0x3c, MIS = 0x40, ICR = 0x44, DMACR = 0x48;
const FR_BUSY = 1 << 3, FR_RXFE = 1 << 4, FR_TXFF = 1 << 5, FR_RXFF = 1 << 6, FR_TXFE = 1 << 7;
const CR_ENABLED = 1, CR_TX = 1 << 8, CR_RX = 1 << 9;
const LCR_FIFOS = 1 << 4, LCR_FORMAT = 0xef, LCR_8N1 = 0x60;
const INT_RX = 1 << 4, INT_TX = 1 << 5, INT_TIMEOUT = 1 << 6, INT_OVERRUN = 1 << 10;
const DMA_RX = 1, DMA_TX = 2;
const FIFO_BYTES = 32;
const LEVELS = [4, 8, 16, 24, 28]; // of IFLS: 1/8, 1/4, 1/2, 3/4, 7/8
const BITS_PER_BYTE = 10;
const TIMEOUT_BITS = 32;
const IRQ_UART0 = 20, DREQ_TX = 20, DREQ_RX = 21;

export class Uart {
  constructor(mcu, clock, problems, speed) {
    this.mcu = mcu;
    this.problems = problems;
    this.speed = speed;
    this.lineBaud = 115200; // of the other end
    this.holdTx = false;
    this.tx = [];
    this.shifting = -1;
    this.rx = [];
    this.incoming = []; // what the host has sent and the line has yet to carry
    this.sent = []; // what the host has received
    this.registers = { [IBRD]: 0, [FBRD]: 0, [LCR_H]: 0, [CR]: CR_TX | CR_RX, [IFLS]: 0x12, [IMSC]: 0, [DMACR]: 0 };
    this.latched = 0; // IBRD and FBRD count from the next write of LCR_H on
    this.raised = 0;
    this.txAlarm = clock.createAlarm(() => this.#txDone());
    this.rxAlarm = clock.createAlarm(() => this.#rxDone());
    this.timeoutAlarm = clock.createAlarm(() => this.#raise(INT_TIMEOUT));
    this.receiving = false;
    this.checkPins = () => {};
  }

  get baud() {
    return this.latched > 0 ? this.mcu.clkPeri / (16 * this.latched) : 0;
  }

  // Bytes from the host, to arrive one after another at the baud rate.
  receive(bytes) {
    for (const byte of bytes) {
      this.incoming.push(byte);
    }
    this.#startRx();
  }

  release() {
    this.holdTx = false;
    this.#startTx();
  }

  takeSent() {
    const bytes = Buffer.from(this.sent);
    this.sent = [];
    return bytes;
  }

  readUint32(offset) {
    switch (offset) {
      case DR: {
        const byte = this.rx.shift() ?? 0;
        this.#rxChanged();
        return byte;
      }
      case RSR:
        return 0;
      case FR:
        return (this.shifting >= 0 || this.tx.length > 0 ? FR_BUSY : 0) | (this.rx.length === 0 ? FR_RXFE : 0) |
          (this.tx.length >= this.#depth ? FR_TXFF : 0) | (this.rx.length >= this.#depth ? FR_RXFF : 0) |
          (this.tx.length === 0 ? FR_TXFE : 0);
      case RIS:
        return this.raised;
      case MIS:
        return this.raised & this.registers[IMSC];
      case ICR:
        return 0;
    }
    if (!(offset in this.registers)) {
      this.problems.add('emulator-warning', `UART0 has no register at offset ${offset.toString(16)}`);
      return 0;
    }
    return this.registers[offset];
  }

  writeUint32Atomic(offset, value, kind) {
    if (offset === ICR) {
      this.raised &= ~value;
      this.#interrupts();
      return;
    }
    if (offset === DR) {
      this.#write(value & 0xff);
      return;
    }
    if (offset === RSR) {
      return;
    }
    if (!(offset in this.registers)) {
      this.problems.add('emulator-warning', `UART0 has no register to write at offset ${offset.toString(16)}`);
      return;
    }
    if ((offset === IBRD || offset === FBRD) && (this.shifting >= 0 || this.tx.length > 0)) {
      this.problems.add('uart-set-up', 'the divider changes while a byte is on its way');
    }
    this.registers[offset] = writeAlias(this.registers[offset], value, kind);
    if (offset === LCR_H) {
      this.latched = (this.registers[IBRD] & 0xffff) + (this.registers[FBRD] & 0x3f) / 64;
    }
    this.#interrupts();
    this.#requests();
    this.#startTx();
  }

  // A fault of wiring or set-up that would garble the line, in words; '' when all is well.
  get wrong() {
    const control = this.registers[CR];
    const off = Math.abs(this.baud / this.lineBaud - 1);
    return (control & CR_ENABLED) === 0 ? 'the UART is not enabled'
      : (control & CR_TX) === 0 || (control & CR_RX) === 0 ? 'transmitter or receiver is off'
      : (this.registers[LCR_H] & LCR_FORMAT & ~LCR_FIFOS) !== LCR_8N1 ? 'the format is not 8N1'
      : off > 0.01 ? `${Math.round(this.baud)} baud is not ${this.lineBaud}`
      : '';
  }

  get #depth() {
    return this.registers[LCR_H] & LCR_FIFOS ? FIFO_BYTES : 1;
  }

  get #txLevel() {
    return this.#depth === 1 ? 0 : LEVELS[this.registers[IFLS] & 7];
  }

  get #rxLevel() {
    return this.#depth === 1 ? 1 : LEVELS[(this.registers[IFLS] >> 3) & 7];
  }

  #write(byte) {
    const wrong = this.wrong || this.checkPins();
    if (wrong) {
      this.problems.add('uart-set-up', wrong);
    }
    if (this.tx.length >= this.#depth) {
      this.problems.add('uart-overflow', 'a byte was written into the full transmit FIFO');
      return;
    }
    this.tx.push(byte);
    this.#startTx();
    if (this.tx.length > this.#txLevel) {
      this.raised &= ~INT_TX;
    }
    this.#interrupts();
    this.#requests();
  }

  #startTx() {
    if (this.shifting < 0 && this.tx.length > 0 && !this.holdTx && this.baud > 0 && this.registers[CR] & CR_ENABLED) {
      this.shifting = this.tx.shift();
      this.txAlarm.schedule((BITS_PER_BYTE * 1e9) / (this.baud * this.speed));
      // Raised as the level is passed downwards, and at no other time: an empty FIFO alone raises nothing.
      if (this.tx.length === this.#txLevel) {
        this.#raise(INT_TX);
      }
      this.#requests();
    }
  }

  #txDone() {
    this.sent.push(this.shifting);
    this.shifting = -1;
    this.#startTx();
  }

  #startRx() {
    if (!this.receiving && this.incoming.length > 0) {
      this.receiving = true;
      this.rxAlarm.schedule((BITS_PER_BYTE * 1e9) / this.lineBaud);
    }
  }

  #rxDone() {
    const byte = this.incoming.shift();
    this.receiving = false;
    // A UART that is not set up hears nothing.
    if (!this.wrong) {
      if (this.rx.length >= this.#depth) {
        this.#raise(INT_OVERRUN);
        this.problems.add('uart-overrun', 'a received byte found the FIFO full');
      } else {
        this.rx.push(byte);
        this.#rxChanged();
        this.timeoutAlarm.schedule((TIMEOUT_BITS * 1e9) / this.baud);
      }
    }
    this.#startRx();
  }

  #rxChanged() {
    if (this.rx.length >= this.#rxLevel) {
      this.#raise(INT_RX);
    } else {
      this.raised &= ~INT_RX;
    }
    if (this.rx.length === 0) {
      this.raised &= ~INT_TIMEOUT;
      this.timeoutAlarm.cancel();
    }
    this.#interrupts();
    this.#requests();
  }

  #raise(bits) {
    this.raised |= bits;
    this.#interrupts();
  }

  #interrupts() {
    this.mcu.setInterrupt(IRQ_UART0, (this.raised & this.registers[IMSC]) !== 0);
  }

  #requests() {
    const { dma } = this.mcu;
    const control = this.registers[DMACR];
    control & DMA_TX && this.tx.length < this.#depth ? dma.setDREQ(DREQ_TX) : dma.clearDREQ(DREQ_TX);
    control & DMA_RX && this.rx.length > 0 ? dma.setDREQ(DREQ_RX) : dma.clearDREQ(DREQ_RX);
  }
}
