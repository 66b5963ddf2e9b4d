// SPDX-License-Identifier: MIT
/** The list of models, with a form for their live parameters. The fields come from the plugin's own table, with unit,
 * range and documentation. A change that a hand may feel suddenly needs consent. */
import {$, element, exact, grouped, short} from './format.js';
import {colourOf, swatchOf} from './colours.js';

const kOpenModels = 3; // if there are more models, their parameters are folded

/** Asks whether the person who holds the arm agrees. */
function consent(text) {
  const dialog = $('consent');
  $('consent-text').textContent = text;
  dialog.returnValue = 'no';
  dialog.showModal();
  return new Promise((resolve) => dialog.addEventListener('close', () => resolve(dialog.returnValue === 'yes'), {once: true}));
}

/** Returns the range of a slider. It is chosen by the present value, because the range in the table is often too wide:
 * 0 to 1e5 for a value of 800. */
function sliderSpan(parameter, value) {
  const about = Math.max(Math.abs(value), (parameter.max - parameter.min) * 1e-3, 1e-9);
  return {min: Math.max(parameter.min, value < 0 ? -4 * about : 0), max: Math.min(parameter.max, 4 * about)};
}

/** Returns the words about a model that is not drawn, or drawn coarser than it is felt; '' about any other. */
function wordsOfDrawing({mesh, error, note, triangles, full_triangles: full, off}) {
  if (!mesh) return `Not drawn: ${error}`;
  return note ? `Drawn with ${grouped(triangles)} of ${grouped(full)} triangles, at most ${Number((off * 1e3).toPrecision(2))} mm off. It is felt exactly.` : '';
}

export class Panel {
  /** @param ask function that sends a request and returns a promise of the answer */
  constructor(ask) {
    this.ask = ask;
    this.control = false;
    this.models = [];
    this.drawings = new Map(); // name -> colours of a model, and words: why it is not drawn, or drawn coarser than it is felt
    this.folder = ''; // folder of the scene file
    this.signature = '';
    $('add-form').addEventListener('submit', (event) => {
      event.preventDefault();
      const file = $('add-file').value.trim(); // a relative path begins at the folder of the scene, as in the scene itself
      this.#do({do: 'add', file: file.startsWith('/') ? file : `${this.folder}/${file}`}).then((answer) => { if (answer.ok) $('add-file').value = ''; });
    });
  }

  /** Shows the models. @param models the models in the answer to `list` @param control true if the page may change the
   * run */
  show(models, control) {
    const shape = JSON.stringify([control, models.map((m) => [m.name, m.plugin, m.enabled, (m.live_parameters ?? []).map((p) => p.id)])]);
    this.models = models;
    this.control = control;
    $('add-form').hidden = !control;
    if (shape !== this.signature) {
      this.signature = shape;
      const focused = this.#focused();
      $('models').replaceChildren(...models.map((model, i) => this.#model(model, i)));
      if (models.length === 0) $('models').append(element('p', {class: 'quiet'}, 'The scene has no model.'));
      if (focused) this.#controlsOf(focused.model)?.[focused.place]?.focus();
    }
    for (const model of models) for (const parameter of model.live_parameters ?? []) this.#refresh(model, parameter);
  }

  #controlsOf(model) { return document.querySelector(`[data-model="${CSS.escape(model)}"]`)?.querySelectorAll('button, input, summary'); }

  /** Returns which control of which model has the focus, so that it gets the focus again when the panel is rebuilt. */
  #focused() {
    const model = document.activeElement?.closest('[data-model]')?.dataset.model;
    return model === undefined ? null : {model, place: [...this.#controlsOf(model)].indexOf(document.activeElement)};
  }

  /** Shows beside each model that is not felt why it is not felt. @param list the list of {model, why} in the status */
  silenced(list) {
    for (const article of document.querySelectorAll('[data-model]')) {
      const why = list.find((s) => s.model === article.dataset.model)?.why ?? '';
      const words = article.querySelector('.silenced');
      words.hidden = why === '';
      if (words.textContent !== why) words.textContent = why;
    }
  }

  /** Shows beside a model its colours and what its drawing lacks. @param answer the answer to `geometry` */
  drawing(name, answer) {
    this.drawings.set(name, {words: wordsOfDrawing(answer), colours: answer.mesh?.colours ?? null});
    this.#showDrawing(document.querySelector(`[data-model="${CSS.escape(name)}"]`));
  }

  #showDrawing(article) {
    if (!article) return;
    const {words, colours} = this.drawings.get(article.dataset.model) ?? {words: '', colours: null};
    article.querySelector('.swatch').style.background = swatchOf(colours, article.dataset.colour);
    const place = article.querySelector('.drawing');
    place.hidden = words === '';
    if (place.textContent !== words) place.textContent = words;
  }

  async #do(request) {
    const answer = await this.ask(request);
    if (!answer.ok) this.onRefused?.(answer.error);
    return answer;
  }

  #model(model, i) {
    const swatch = element('i', {class: 'swatch'});
    const head = element('header', {}, swatch, element('h3', {title: model.name}, model.name, element('small', {}, model.plugin)));
    if (this.control) {
      const able = element('button', {type: 'button', title: model.enabled ? 'Fade its force out; it is still traced' : 'Fade its force in'}, model.enabled ? 'Disable' : 'Enable');
      able.onclick = () => this.#do({do: model.enabled ? 'disable' : 'enable', model: model.name});
      const remove = element('button', {type: 'button', title: 'Fade its force out and remove it', 'aria-label': `Remove ${model.name}`}, '✕');
      remove.onclick = () => this.#do({do: 'remove', model: model.name});
      head.append(able, remove);
    }
    const live = model.live_parameters ?? [];
    const fields = this.control ? live.map((parameter) => this.#field(model, parameter)) : [];
    const body = this.models.length > kOpenModels && fields.length > 0
      ? [element('details', {}, element('summary', {}, `${fields.length} parameters`), ...fields)] : fields;
    const silenced = element('p', {class: 'wrong silenced', hidden: true, role: 'status'});
    const drawing = element('p', {class: 'quiet drawing', hidden: true});
    const article = element('article', {class: 'model', data: {model: model.name, colour: colourOf(model.plugin, model.number ?? i)}}, head, silenced, drawing, ...body);
    this.#showDrawing(article);
    return article;
  }

  #field(model, parameter) {
    const id = `p-${model.name}-${parameter.id}`, value = parameter.value;
    const number = element('input', {type: 'number', id, step: parameter.whole ? 1 : 'any', min: parameter.min, max: parameter.max, value: value ?? ''});
    const slider = element('input', {type: 'range', step: parameter.whole ? 1 : 'any', 'aria-label': parameter.id});
    const wrong = element('p', {class: 'wrong', hidden: true});
    const set = async () => {
      wrong.hidden = true;
      wrong.textContent = await this.#set(model, parameter, number);
      wrong.hidden = wrong.textContent === '';
      this.#refresh(model, parameter, true);
    };
    number.onchange = set;
    slider.oninput = () => { number.value = Number(Number(slider.value).toPrecision(4)); };
    slider.onchange = set;
    const consents = parameter.safety ? ' A hand may feel a change suddenly, so the page asks first.' : '';
    const title = parameter.doc ? `${parameter.doc} ${exact(parameter.min)} to ${exact(parameter.max)} ${parameter.unit}${consents}` : parameter.id;
    return element('div', {class: parameter.safety ? 'field safety' : 'field', data: {parameter: parameter.id}},
      element('label', {htmlFor: id, title}, parameter.label ?? parameter.id), ...(Number.isFinite(value) ? [slider] : []), number,
      element('span', {class: 'unit'}, parameter.unit), wrong);
  }

  /** Sets a parameter to the number in its field. Returns why it was not set; '' if it was, or if the person at the arm does not agree. */
  async #set(model, parameter, {value: typed, valueAsNumber: wanted}) {
    if (!(wanted >= parameter.min && wanted <= parameter.max))
      return `${typed === '' ? 'no number is given' : `${typed} is out of range`}, expected ${exact(parameter.min)} to ${exact(parameter.max)} ${parameter.unit}`;
    const before = Number.isFinite(parameter.value) ? ` from ${short(parameter.value)}` : '';
    const agreed = !parameter.safety || await consent(`${parameter.label ?? parameter.id} of ${model.name} changes${before} to ${short(wanted)} ${parameter.unit}. A hand may feel that suddenly.`);
    if (!agreed) return '';
    const answer = await this.ask({do: 'set', model: model.name, parameter: parameter.id, value: wanted, ...(parameter.safety ? {consent: true} : {})});
    if (answer.ok) parameter.value = wanted;
    return answer.ok ? '' : answer.error;
  }

  /** Shows the present value, unless somebody is typing another one. */
  #refresh(model, parameter, force = false) {
    const field = document.querySelector(`[data-model="${CSS.escape(model.name)}"] [data-parameter="${CSS.escape(parameter.id)}"]`);
    if (!field || !Number.isFinite(parameter.value)) return;
    const number = field.querySelector('input[type=number]'), slider = field.querySelector('input[type=range]');
    if (!force && (document.activeElement === number || document.activeElement === slider)) return;
    number.value = Number(parameter.value.toPrecision(6));
    if (slider) Object.assign(slider, sliderSpan(parameter, parameter.value), {value: parameter.value});
  }
}
