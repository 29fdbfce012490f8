// Panels: which are open, what the help says, and whether fingers or keys are in use.

const panel_names = ['adjust', 'lights', 'help'];
/** As in page.css: there is room for one panel. */
const small_screen = matchMedia('(max-width: 699px), (max-height: 499px)');

/** Opens or closes a panel; others close that lie in the same place. */
function toggle_panel(name, on = element(name).hidden) {
  element(name).hidden = !on;
  for (const other of panel_names) {
    const same_place = small_screen.matches || (name !== 'lights' && other !== 'lights');
    if (on && other !== name && same_place) element(other).hidden = true;
  }
  show_open_panels();
  return true;
}

function show_open_panels() {
  const open = panel_names.filter((name) => !element(name).hidden);
  document.body.dataset.open = open.join(' ');
  for (const name of panel_names) element(`open-${name}`).setAttribute('aria-expanded', open.includes(name));
}

function set_up_panels() {
  for (const name of panel_names) {
    element(`open-${name}`).addEventListener('click', () => toggle_panel(name));
    element(name).querySelector('.close').addEventListener('click', () => {
      toggle_panel(name, false);
      element(`open-${name}`).focus();
    });
  }
  small_screen.addEventListener('change', () => {
    const open = panel_names.filter((name) => !element(name).hidden);
    if (open.length > 0) toggle_panel(open[0], true);
  });
}

/** Marks the document while fingers are in use, and once keys are: both see their own controls and help. */
function watch_devices() {
  const fingers = matchMedia('(pointer: coarse)'), {classList} = document.body;
  const look = () => {
    classList.toggle('touch', fingers.matches);
    classList.toggle('keyboard', !fingers.matches);
  };
  fingers.addEventListener('change', look);
  look();
  window.addEventListener('pointerdown', (event) => {
    classList.toggle('touch', event.pointerType === 'touch' || fingers.matches);
    classList.remove('tabbed');
  }, true);
  window.addEventListener('keydown', ({key}) => {
    classList.add('keyboard');
    if (key === 'Tab') classList.add('tabbed');  // the focus is sought, so the picture shows it too
  }, true);
}

/** Whether a key is for the control that has the focus. */
function is_for_control({target, code, key}) {
  if (!(target instanceof Element) || !element('layout').contains(target) || key === 'Escape') return false;
  if (target instanceof HTMLSelectElement || target.type === 'number') return true;
  if (target.type === 'range') return /^(Arrow|Home|End|Page)/.test(code);
  return code === 'Space' || code === 'Enter';
}

/** Rows of the help: what is pressed, a text's key if it starts with 'key_'; what that does. */
const finger_help = [
  ['key_tap', 'help_tap'], ['key_double_tap', 'help_go'], ['key_drag', 'help_look'], ['key_pinch', 'help_pinch'],
  ['key_stick', 'help_stick'], ['key_plan_fingers', 'help_plan_fingers'],
];
const key_help = [
  ['W S, ↑ ↓', 'help_walk'], ['A D, ← →', 'help_aside'], ['Q E', 'help_turn'], ['key_space, C', 'help_rise'],
  ['key_shift', 'help_run'], ['key_mouse_drag', 'help_look'], ['L', 'help_lock'], ['key_mouse', 'help_read'],
  ['key_click', 'help_keep'], ['key_double_click', 'help_go'], ['key_wheel', 'help_wheel'], ['1 … 9', 'help_cameras'],
  ['R', 'help_start'], ['O', 'help_orbit'], ['P', 'help_plan'], ['+ −', 'help_exposure'], ['0', 'help_expose'],
  ['B', 'help_adjust'], ['V, U', 'help_measures'], ['I', 'help_isolux'], ['G', 'help_measure'], ['T', 'help_lights'], ['. , ;', 'help_cues'],
  ['M', 'help_outlines'], ['X', 'help_through'], ['H, ?', 'help_help'],
];

function fill_help(table, rows) {
  table.replaceChildren(...rows.map(([keys, does]) => {
    const row = document.createElement('tr'), head = document.createElement('th'), cell = document.createElement('td');
    head.textContent = keys.replace(/key_\w+/g, (key) => text(key));
    cell.textContent = text(does);
    if (does === 'help_lights') row.hidden = element('open-lights').hidden;
    if (does === 'help_cues') row.hidden = element('cue-row').hidden;
    row.append(head, cell);
    return row;
  }));
}
