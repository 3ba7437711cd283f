// The help over the page.
import { byTest, el, icon } from './dom.js';
import { fill, onLanguage } from './words.js';

const MOUSE = [
  ['k_left_drag', 'h_turn'], ['k_right_drag', 'h_move'], ['k_wheel', 'h_zoom'], ['k_double', 'h_select'],
  ['k_ctrl_drag', 'h_push'], ['k_handle', 'h_target'], ['k_ghost', 'h_ghost'],
];
const TOUCH = [
  ['k_one_finger', 'h_turn'], ['k_two_fingers', 'h_move_zoom'], ['k_double_tap', 'h_select'],
  ['k_long_press', 'h_push'], ['k_handle', 'h_target'],
];
const KEYS = [
  ['k_space', 'h_pause'], ['k_arrows', 'h_step'], ['k_plus', 'h_speed'], ['k_backspace', 'h_reset'],
  ['=T', 'h_target_key'], ['k_shift_arrows', 'h_turn'], ['=W A S D', 'h_move'], ['k_pages', 'h_zoom'],
  ['k_home', 'h_first_view'], ['=1 2 3', 'h_presets'], ['=F', 'h_fit'], ['=[ ]', 'h_cameras'],
  ['=C', 'h_collision'], ['=B', 'h_panels'], ['=P', 'h_picture'], ['=?', 'h_help'],
];
const LEAD = [['=W S A D Q E', 'h_lead'], ['k_lead_turn', 'h_lead_turn'], ['=G H', 'h_lead_grip']];

export class Help {
  #node = byTest('help-panel');

  /** @param {boolean} leads  an arm is led */
  constructor(leads) {
    const close = el('button', {
      type: 'button', class: 'tool', test: 'help-close', wordLabel: 'close', on: { click: () => this.#node.close() },
    }, icon('close'));
    this.#node.append(
      el('header', {}, el('h2', { word: 'help_title' }), close),
      el('div', { class: 'columns' },
        el('div', {}, ...part('help_mouse', MOUSE), ...part('help_touch', TOUCH)),
        el('div', {}, ...(leads ? part('help_lead', LEAD) : []), ...part('help_keys', KEYS))),
      el('p', { class: 'hint', word: 'h_values' }),
    );
    this.#node.addEventListener('click', (event) => {
      if (event.target === this.#node) this.#node.close(); // beside it
    });
    byTest('help').addEventListener('click', () => this.toggle());
    onLanguage(() => fill(this.#node));
    fill(this.#node);
  }

  get open() {
    return this.#node.open;
  }

  toggle() {
    if (this.#node.open) this.#node.close();
    else this.#node.showModal();
  }
}

function part(title, rows) {
  const list = el('dl', {}, ...rows.flatMap(([keys, about]) => {
    const key = keys.startsWith('=') ? el('kbd', {}, keys.slice(1)) : el('kbd', { word: keys });
    return [el('dt', {}, key), el('dd', { word: about })];
  }));
  return [el('h3', { word: title }), list];
}
