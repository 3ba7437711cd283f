// The program under test: `mjarm serve` as a process, and what other commands of mjarm say.
import { execFile, spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { createServer } from 'node:net';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';

const FIRST_LINE = 20000; // [ms] until it says its address

function findProgram() {
  if (process.env.MJARM_PROGRAM) return process.env.MJARM_PROGRAM;
  const inBuild = (preset) => fileURLToPath(new URL(`../../build/${preset}/bin/mjarm`, import.meta.url));
  return ['dev', 'release'].map(inBuild).find((path) => existsSync(path)) ?? 'mjarm';
}
const MJARM = findProgram();
const ENVIRONMENT = { ...process.env, LC_ALL: 'C.UTF-8', LANGUAGE: '' };

/** What `mjarm ARGS` prints, as JSON. @param {...string} args */
export async function askMjarm(...args) {
  const { stdout } = await promisify(execFile)(MJARM, args, { env: ENVIRONMENT });
  return JSON.parse(stdout);
}

/** Runs `mjarm ARGS` to its end, which has to be good. @param {...string} args */
export async function runMjarm(...args) {
  await promisify(execFile)(MJARM, args, { env: ENVIRONMENT });
}

/** A port that was free a moment ago. @returns {Promise<number>} */
export function freePort() {
  return new Promise((resolve, reject) => {
    const trial = createServer().once('error', reject);
    trial.listen(0, '127.0.0.1', () => {
      const { port } = trial.address();
      trial.close(() => resolve(port));
    });
  });
}

/** A running server. */
export class Program {
  #process;
  #exit;

  /** @param {string[]} args  of `mjarm serve`, or of `mjarm teleop` with that word first @param {object} [environment]  added to its own */
  static async serve(args, environment = {}) {
    const program = new Program(args, environment);
    program.url = await program.#address();
    return program;
  }

  constructor(args, environment) {
    const env = { ...ENVIRONMENT, ...environment };
    const words = args[0] === 'teleop' ? [...args, '--serve'] : ['serve', ...args];
    this.#process = spawn(MJARM, words, { stdio: ['ignore', 'pipe', 'inherit'], env });
    this.#exit = new Promise((resolve) => this.#process.once('exit', (code, signal) => resolve(code ?? signal)));
    process.once('exit', () => this.#process.kill('SIGKILL'));
  }

  /** Ends it as Ctrl-C does. @returns {Promise<number|string>} its exit code, or the signal that ended it */
  stop() {
    this.#process.kill('SIGINT');
    return this.#exit;
  }

  /** Ends it in the middle of what it does. */
  kill() {
    this.#process.kill('SIGKILL');
    return this.#exit;
  }

  #address() {
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error('mjarm serve says no address')), FIRST_LINE);
      let text = '';
      this.#process.once('error', reject);
      this.#exit.then((code) => reject(new Error(`mjarm serve ended: ${code}`)));
      this.#process.stdout.on('data', (data) => {
        text += data;
        const found = /^(http:\S+\/)\s/.exec(text.replace('（', ' '));
        if (!found) return;
        clearTimeout(timer);
        resolve(found[1]);
      });
    });
  }
}
