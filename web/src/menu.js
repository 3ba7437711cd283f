// Settings of the page: appearance, language, what is shown.
import { byTest, el } from './dom.js';
import { remember } from './settings.js';
import { theme } from './theme.js';
import { fill, label, language, onLanguage, setLanguage, t } from './words.js';

export class Menu {
  #node = byTest('menu-panel');
  #button = byTest('menu');
  #model;
  #groups;

  /** @param {{model: object, stage: object, overlay: object, onGroups: () => void}} around */
  constructor({ model, stage, overlay, onGroups }) {
    this.#model = model;
    this.#groups = model.usedGroups().map((group) => ({
      group, ...check(`group-${group}`, model.groups[group], (on) => {
        model.setGroup(group, on);
        onGroups();
      }),
    }));
    const shadows = check('shadows', stage.shadows, (on) => stage.setShadows(on), 'shadows');
    const grid = check('grid', true, (on) => {
      model.floor.setGrid(on);
      stage.changed();
    }, 'grid');
    const labels = check('labels', overlay.labels, (on) => overlay.setLabels(on), 'labels');
    this.shadows = shadows.box;
    this.#node.append(
      this.#select('theme', 'theme', ['auto', 'light', 'dark'].map((name) => [name, `theme_${name}`]), theme.choice,
        (choice) => theme.choose(choice)),
      this.#languages(),
      shadows.node, grid.node, labels.node,
      el('h3', { word: 'groups' }), el('div', { class: 'group' }, ...this.#groups.map(({ node }) => node)),
    );
    this.#button.addEventListener('click', () => this.toggle());
    document.addEventListener('pointerdown', (event) => {
      const inside = this.#node.contains(event.target) || this.#button.contains(event.target);
      if (!this.#node.hidden && !inside) this.close();
    }, true);
    this.#node.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape') return;
      event.stopPropagation();
      this.close();
      this.#button.focus();
    });
    onLanguage(() => this.#words());
    fill(this.#node);
    this.#words();
  }

  toggle() {
    if (!this.#node.hidden) {
      this.close();
      return;
    }
    this.#node.hidden = false;
    this.#button.setAttribute('aria-expanded', 'true');
    this.#node.querySelector('select').focus();
  }

  close() {
    this.#node.hidden = true;
    this.#button.setAttribute('aria-expanded', 'false');
  }

  /** After a change of groups from elsewhere. */
  update() {
    for (const { group, box } of this.#groups) box.checked = this.#model.groups[group];
  }

  #select(test, word, options, current, use) {
    const on = { change: () => use(menu.value) };
    const menu = el('select', { class: 'pick', test: `${test}-select`, wordLabel: word, on },
      ...options.map(([value, key]) => el('option', { value, word: key })));
    menu.value = current;
    return el('div', { class: 'row pick-row' }, el('span', { class: 'name', word }), menu);
  }

  #languages() {
    const use = () => {
      remember('language', menu.value);
      setLanguage(menu.value);
    };
    const menu = el('select', { class: 'pick', test: 'language-select', wordLabel: 'language', on: { change: use } },
      el('option', { value: 'en', lang: 'en' }, 'English'), el('option', { value: 'zh', lang: 'zh-CN' }, '中文'));
    menu.value = language();
    return el('div', { class: 'row pick-row' }, el('span', { class: 'name', word: 'language' }), menu);
  }

  #words() {
    for (const { group, name, box } of this.#groups) {
      name.textContent = t('group', group);
      label(box, t('group', group));
    }
  }
}

function check(test, on, use, word) {
  const box = el('input', { type: 'checkbox', test, on: { change: () => use(box.checked) } });
  box.checked = on;
  const name = el('span', { word });
  return { node: el('label', { class: 'switch' }, box, name), name, box };
}
