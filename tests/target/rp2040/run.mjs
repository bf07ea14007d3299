// Runs a Pico's image:
//
//     node run.mjs IMAGE.uf2 --modules DIR --trace FILE [--uart-speed N] [--stack BEGIN-END] [--frame-at ADDRESS]
//         (--stdio | --tcp PORT)
//
// --frame-at: frames are told apart by the program's arrival there, not on the wire.
//
// --stdio: a line of JSON on standard input is a step, a line on standard output its outcome. Nothing happens in
// between, so that a run is the same each time, however slow the machine. A step is {"ns": time to pass, "rx": bytes
// from the host in base64, "baud": the rate of the host's end from now on, "hold_tx": true while the line takes nothing, "until_frame": true to stop at a picture's
// end, "report": true for all that is known}; all members are optional.
//
// --tcp: `edgeline view -p socket://127.0.0.1:PORT` shows the emulated board; emulated time passes no faster than real
// time. A report is printed when the host closes the link.
//
// Status 2 and one line on standard error for a bad command line or file.

import { readFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { createInterface } from 'node:readline';

import { Board } from './board.mjs';
import { loadUf2 } from './image.mjs';

const SLICE_NS = 2e6;

function options(words) {
  const given = { 'uart-speed': '1' };
  while (words.length > 0) {
    const word = words.shift();
    if (word === '--stdio') {
      given.stdio = true;
    } else if (/^--(modules|trace|uart-speed|stack|frame-at|tcp)$/.test(word) && words.length > 0) {
      given[word.slice(2)] = words.shift();
    } else if (!word.startsWith('--') && given.image === undefined) {
      given.image = word;
    } else {
      throw new Error(`${word}: no such option, or its value is missing`);
    }
  }
  for (const name of ['image', 'modules', 'trace']) {
    if (given[name] === undefined) {
      throw new Error(`${name === 'image' ? 'the image' : `--${name}`} is missing`);
    }
  }
  if ((given.stdio === undefined) === (given.tcp === undefined)) {
    throw new Error('say either --stdio or --tcp PORT');
  }
  return given;
}

function createBoard(given) {
  const [begin, end] = (given.stack ?? '').split('-').map(Number);
  return new Board({
    modules: given.modules,
    image: loadUf2(readFileSync(given.image)),
    tracePath: given.trace,
    uartSpeed: Number(given['uart-speed']),
    stack: end > begin ? { begin, end } : null,
    frameAt: Number(given['frame-at'] ?? 0),
  });
}

function step(board, { ns = 0, rx = '', baud = 0, hold_tx = false, until_frame = false, report = false }) {
  board.uart.lineBaud = baud || board.uart.lineBaud;
  board.uart.receive(Buffer.from(rx, 'base64'));
  if (hold_tx) {
    board.uart.holdTx = true;
  } else {
    board.uart.release();
  }
  board.run(board.clock.nanos + ns, until_frame);
  board.trace.flush();
  return {
    now_ns: Math.floor(board.clock.nanos),
    tx: board.uart.takeSent().toString('base64'),
    frame_ends: board.display.frameEnds.length,
    fatal: board.problems.fatal,
    ...(report ? { report: board.report } : {}),
  };
}

async function serveSteps(board) {
  for await (const line of createInterface({ input: process.stdin })) {
    process.stdout.write(`${JSON.stringify(step(board, JSON.parse(line)))}\n`);
  }
  board.trace.close();
}

function serveTcp(board, port) {
  const server = createServer((socket) => {
    server.close();
    const began = performance.now();
    const slice = () => {
      const ahead = board.clock.nanos / 1e6 - (performance.now() - began);
      if (ahead > 0) {
        setTimeout(slice, ahead);
        return;
      }
      board.run(board.clock.nanos + SLICE_NS);
      socket.write(board.uart.takeSent());
      if (socket.destroyed || board.problems.fatal) {
        board.trace.close();
        console.log(JSON.stringify(board.report, null, 2));
        process.exit(board.problems.fatal ? 1 : 0);
      }
      setImmediate(slice);
    };
    socket.on('data', (bytes) => board.uart.receive(bytes));
    socket.on('error', () => socket.destroy());
    slice();
  });
  server.listen(port, '127.0.0.1');
}

try {
  const given = options(process.argv.slice(2));
  const board = createBoard(given);
  if (given.stdio) {
    await serveSteps(board);
  } else {
    serveTcp(board, Number(given.tcp));
  }
} catch (error) {
  process.stderr.write(`run.mjs: ${error.message.split('\n')[0]}\n`);
  process.exit(2);
}
