// SPI0 and the lines beside it, as the display sees them. A word takes the time of its bits, and only when it has ended
// is D/C sampled and the word handed to the display: firmware that does not wait for the bus sends commands as data
// here, as on silicon. Everything that a logic analyser would show as wrong is a problem of its own name.
//
// The wiring is that of firmware/boards/rp2040/WIRING.md.

import { hex } from './problems.mjs';

const SCK = 18, TX = 19, CS = 17, DC = 20, RST = 21;
const FUNCTION_SPI = 1, FUNCTION_SIO = 5;
const PAD_OUTPUT_DISABLED = 1 << 7;
const CR0 = 0x00, CR1 = 0x04, DR = 0x08, CPSR = 0x10; // PL022, Arm DDI 0194, table 3-1
const CR0_BITS = 0x0f, CR0_FRAME = 0x30, CR0_MODE = 0xc0;
const CR1_ENABLED = 2, CR1_SLAVE_OR_LOOP = 5;
const DMACR_TX = 2;
const SPI0_DR = 0x4003c008;
const TREQ_SPI0_TX = 16;
const DMA_BSWAP = 1 << 22, DMA_INCREMENT_READ = 1 << 4;
// Table 4-100 of the RP2040's data sheet: clk_peri / 2 is the fastest; the displays take what the project promises.
const FASTEST_HZ = 62.5e6;
const RAMWR = 0x2c;

export class DisplayBus {
  constructor(mcu, clock, problems, trace, checkClocks) {
    this.mcu = mcu;
    this.clock = clock;
    this.spi = mcu.spi[0];
    this.problems = problems;
    this.trace = trace;
    this.checkClocks = checkClocks;
    this.storeBytes = 0; // of the CPU's store that is under way, 0 for DMA
    this.channel = { readAddr: 0, transCount: 0 }; // that feeds the display
    this.channelEnd = 0;
    this.inPixels = false;
    this.frameEnds = []; // where in the trace each picture was complete
    this.words = 0;
    this.pixelHz = 0;
    this.wireNs = 0;
    this.onBand = () => {};
    this.onFrameEnd = () => {};
    this.word = 0;
    this.wordDc = 0;
    this.wordEnd = clock.createAlarm(() => this.#wordEnds());
    this.spi.onTransmit = (value) => this.#wordBegins(value);
    this.#watchRegisters();
    this.#watchLines();
    this.#watchDma();
  }

  get busy() {
    return this.spi.busy || !this.spi.txFIFO.empty;
  }

  // What the DMA has still to read must not change.
  checkStore(address, bytes) {
    if (address + bytes > this.channel.readAddr && address < this.channelEnd && this.channel.transCount > 0) {
      this.problems.add('dma-overwrite', `${hex(address)} was written before the DMA had read it`);
    }
  }

  #watchRegisters() {
    const { spi, problems } = this;
    const write = spi.writeUint32.bind(spi);
    spi.writeUint32 = (offset, value) => {
      if (offset === DR) {
        this.#checkData(value);
      } else if (offset === CR0 && value !== spi.control0) {
        if (this.busy) {
          const what = (value ^ spi.control0) & CR0_BITS ? 'the word size' : 'the SPI format';
          problems.add('word-size-while-busy', `${what} changed while the bus was busy`);
        }
      } else if (offset === CPSR && value !== spi.clockDivisor) {
        if (this.busy) {
          problems.add('word-size-while-busy', 'the SPI clock changed while the bus was busy');
        }
        if (value < 2 || value & 1) {
          problems.add('spi-clock', `a clock divisor of ${value}: 2..254 and even is what the SPI takes`);
        }
      } else if (offset === CR1 && (value & CR1_ENABLED) === 0) {
        if (this.busy) {
          problems.add('spi-disabled', 'the SPI was disabled while the bus was busy');
        }
        // What its clock line does then is nobody's promise.
        if ((this.mcu.sio.gpioValue & (1 << CS)) === 0) {
          problems.add('disabled-while-selected', 'the SPI was disabled while chip select was low');
        }
      }
      write(offset, value);
    };
  }

  #checkData(value) {
    const { spi, problems } = this;
    if (spi.txFIFO.full) {
      problems.add('fifo-overflow', 'a word was written into the full transmit FIFO');
    }
    const bits = spi.dataBits;
    const bytes = this.storeBytes || this.channel.dataSize;
    if (bits !== 8 && bits !== 16) {
      problems.add('word-width', `words of ${bits} bits`);
    } else if (bits === 16 && bytes === 1) {
      problems.add('word-width', 'a byte was written while words had 16 bits');
    } else if (bytes * 8 > bits && (value & ((2 ** (8 * bytes)) - 1)) >>> 0 >= 2 ** bits) {
      problems.add('word-width', `${hex(value)} was written while words had ${bits} bits`);
    }
  }

  #watchLines() {
    const { mcu, problems } = this;
    const edge = (name, kind) => () => {
      if (this.busy) {
        problems.add(kind, `${name} changed while the bus was busy`);
      }
    };
    mcu.gpio[DC].addListener(edge('D/C', 'dc-while-busy'));
    mcu.gpio[CS].addListener(edge('chip select', 'cs-while-busy'));
    mcu.gpio[RST].addListener((value) => {
      if (value === 0 || value === 1) {
        this.trace.reset(value, this.clock.nanos);
      }
    });
  }

  #watchDma() {
    for (const channel of this.mcu.dma.channels) {
      const start = channel.start.bind(channel);
      channel.start = () => {
        const running = channel.active;
        start();
        if (!running && channel.active && channel.writeAddr >>> 0 === SPI0_DR) {
          this.#bandBegins(channel);
        }
      };
      const write = channel.writeUint32.bind(channel);
      channel.writeUint32 = (offset, value) => {
        if (channel === this.channel && channel.active) {
          this.problems.add('dma-set-up', 'the DMA channel was written while it fed the display');
        }
        write(offset, value);
      };
    }
  }

  #bandBegins(channel) {
    const { spi, problems } = this;
    if (this.channel.transCount > 0 && this.channel !== channel && this.channel.active) {
      problems.add('dma-set-up', 'a second DMA channel feeds the display while the first one does');
    }
    this.channel = channel;
    this.channelEnd = (channel.readAddr >>> 0) + channel.transCount * channel.dataSize;
    const wrong =
      channel.treqValue !== TREQ_SPI0_TX ? `paced by request ${channel.treqValue}, not by SPI0 (16)`
      : (spi.dmaControl & DMACR_TX) === 0 ? 'the SPI does not ask for data: SSPDMACR.TXDMAE is 0'
      : channel.dataSize * 8 !== spi.dataBits ? `${channel.dataSize} bytes at a time into words of ${spi.dataBits} bits`
      : (channel.readAddr & (channel.dataSize - 1)) !== 0 ? `reads from ${hex(channel.readAddr)}, which is not aligned`
      : channel.ctrl & DMA_BSWAP ? 'swaps bytes, though the SPI sends the high byte first'
      : (channel.ctrl & DMA_INCREMENT_READ) === 0 && channel.transCount > 1 ? 'sends the same word again and again'
      : '';
    if (wrong) {
      problems.add('dma-set-up', wrong);
    }
    this.onBand();
  }

  // Of the lines and the SPI, at one moment of a word.
  #check() {
    const { mcu, spi, problems } = this;
    const { gpio, sio } = mcu;
    if (gpio[SCK].ctrl !== FUNCTION_SPI || gpio[TX].ctrl !== FUNCTION_SPI) {
      problems.add('pin-function', 'GP18 and GP19 are not SPI0 SCK and TX (function 1)');
    }
    if (gpio[CS].ctrl !== FUNCTION_SIO || gpio[DC].ctrl !== FUNCTION_SIO || gpio[RST].ctrl !== FUNCTION_SIO) {
      problems.add('pin-function', 'GP17, GP20 and GP21 are not outputs of the processor (function 5)');
    }
    for (const pin of [SCK, TX, CS, DC, RST]) {
      if (gpio[pin].padValue & PAD_OUTPUT_DISABLED) {
        problems.add('pin-function', `the pad of GP${pin} has its output disabled`);
      }
    }
    const driven = (1 << CS) | (1 << DC) | (1 << RST);
    if ((sio.gpioOutputEnable & driven) !== driven) {
      problems.add('pin-function', 'GP17, GP20 or GP21 is not driven');
    }
    if (sio.gpioValue & (1 << CS)) {
      problems.add('cs-high', 'a word went out while chip select was high');
    }
    if (!spi.enabled) {
      problems.add('spi-disabled', 'a word was written while the SPI was disabled');
    }
    if (spi.control1 & CR1_SLAVE_OR_LOOP) {
      problems.add('spi-format', 'the SPI is a slave or loops back');
    }
    const mode = spi.control0 & CR0_MODE;
    if (spi.control0 & CR0_FRAME || (mode !== 0 && mode !== CR0_MODE)) {
      problems.add('spi-format', 'neither mode 0 nor mode 3 of Motorola format');
    }
  }

  #wordBegins(value) {
    const { spi } = this;
    this.#check();
    if (this.words === 0) {
      this.checkClocks();
    }
    const hz = spi.clockFrequency;
    if (!(hz > 0 && hz <= FASTEST_HZ)) {
      this.problems.add('spi-clock', `${hz} Hz`);
    }
    this.word = value;
    this.wordDc = this.#dc();
    const ns = hz > 0 ? (spi.dataBits * 1e9) / hz : 1e6;
    this.wireNs += ns;
    this.wordEnd.schedule(ns);
  }

  #wordEnds() {
    const { spi, clock } = this;
    const dc = this.#dc();
    this.#check();
    if (dc !== this.wordDc) {
      this.problems.add('dc-while-busy', 'D/C was not the same from the first bit of a word to its last');
    }
    if (dc === 0) {
      if (this.inPixels) {
        this.frameEnds.push(this.trace.length);
        this.onFrameEnd();
      }
      this.inPixels = (this.word & 0xff) === RAMWR;
      if (spi.dataBits !== 8) {
        this.problems.add('word-width', 'a command of 16 bits');
      }
    } else if (this.inPixels) {
      this.pixelHz = spi.clockFrequency;
    }
    this.words++;
    if (spi.dataBits === 16) {
      this.trace.byte(dc, this.word >> 8, clock.nanos);
    }
    this.trace.byte(dc, this.word & 0xff, clock.nanos);
    spi.completeTransmit(0);
  }

  #dc() {
    return (this.mcu.sio.gpioValue >> DC) & 1;
  }
}
