// A program that serves, a page that shows it, and a witness beside.
import { ok, strictEqual } from 'node:assert/strict';
import { byTest, openPage } from './browser.mjs';
import { Program } from './program.mjs';
import { Witness } from './witness.mjs';

export class Session {
  /** @param {string[]} args  of `mjarm serve` @param {object} [look]  of the page, see openPage */
  async open(args, look, environment) {
    this.program = await Program.serve(args, environment);
    this.page = await openPage(this.program.url, look);
    this.witness = await Witness.open(this.program.url);
  }

  async close() {
    this.witness?.close();
    await this.page?.context().close();
    await this.program?.stop();
  }

  /** The program as it begins, whatever was before; the page looks from where it did at first. */
  async begin() {
    const { witness, page } = this;
    witness.send({ type: 'speed', speed: 1 });
    witness.send({ type: 'pause', paused: false });
    witness.send({ type: 'reset' });
    await witness.until('a new beginning', () => witness.frame.time < 0.5 && !witness.frame.paused);
    await byTest(page, 'camera').selectOption('first');
    if (!witness.scene.options.can_target) return;
    await this.check('Target', true, 'Target');
    await this.check('Follow', true);
  }

  control(name) {
    return byTest(this.page, name);
  }

  /** What shows an item of the panels. @param {string} name  English @param {string} [section] */
  panel(name, section) {
    return this.control(`panel-${this.witness.item(name, section).id}`);
  }

  /** Switches a checkbox of the panels and waits until the program has it so. */
  async check(name, on, section) {
    const { witness, page } = this;
    // The page may learn later than the witness how things stand, which may go on changing.
    const isSeen = ([id, was]) => window.mjarm.switches[id] === was
      && document.querySelector(`[data-test="panel-${id}"]`).checked === was;
    const state = () => [witness.item(name, section).id, witness.item(name, section).on];
    for (const end = Date.now() + 30000; ; await page.waitForTimeout(20)) {
      if (state()[1] === on) return;
      if (await page.evaluate(isSeen, state())) break;
      ok(Date.now() < end, `the page does not show "${name}" as it is: ${state()}`);
    }
    await this.panel(name, section).click();
    await witness.until(`"${name}" to be ${on}`, () => witness.item(name, section).on === on);
  }

  /** Chooses a word of the panels and waits until the program has it so. */
  async choose(name, word, section) {
    const { witness } = this;
    await this.panel(name, section).selectOption(word);
    await witness.until(`"${name}" to be ${word}`, () => {
      const { words, current } = witness.item(name, section);
      return words[current] === word;
    });
  }

  /** [pixels] where a point of the world is seen. @param {number[]} point */
  async pixel(point) {
    const { x, y } = await this.page.evaluate((p) => window.mjarm.project(p), point);
    return [x, y];
  }

  /** Nobody complained: neither the page in its console, nor the program about what the page sent. */
  assertNoFaults() {
    strictEqual(this.page.faults.join('\n'), '');
  }
}
