// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The parts of the HTML page that are the same in every report. Everything is inline: the page
/// must open from a CI archive, without a network, and years later. Without its script, as where a
/// CI server forbids it, all is still there to be read.
namespace armjig::page {

/// Verdicts set `--c`, series `--s`; a reader without colours has the words and the dashes.
inline constexpr std::string_view kStyle = R"css(
:root { color-scheme: light dark;
  --paper: light-dark(#f6f8fa, #0e1218); --card: light-dark(#fff, #161b23);
  --sunk: light-dark(#f3f5f8, #10151c); --ink: light-dark(#1a2330, #e5eaf1);
  --soft: light-dark(#566274, #9ba8b9); --line: light-dark(#dbe1e9, #2b3440);
  --pass: light-dark(#14703a, #57cb8b); --fail: light-dark(#b8211b, #ff8a82);
  --deviation: light-dark(#825400, #e3b454); --flaky: light-dark(#a83a00, #ff9c5b);
  --error: light-dark(#7a2fb5, #cba0f5); --unclear: light-dark(#2459a8, #85b5f8);
  --mono: ui-monospace, SFMono-Regular, Menlo, Consolas, "DejaVu Sans Mono", monospace; }
:root[data-theme=light] { color-scheme: light; }
:root[data-theme=dark] { color-scheme: dark; }
* { box-sizing: border-box; }
[hidden] { display: none !important; }
body { margin: 0 auto; max-width: 76rem; padding: 1.75rem 1.5rem 4rem; background: var(--paper);
  color: var(--ink); font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans",
  "DejaVu Sans", sans-serif; overflow-wrap: anywhere; -webkit-text-size-adjust: 100%; }
h1, h2, h3, p, dl, dd, ul, figure, pre { margin: 0; padding: 0; }
h1 { font-size: 1.6rem; line-height: 1.25; letter-spacing: -.01em; text-wrap: balance; }
h2 { font-size: 1.2rem; margin: 2.5rem 0 .75rem; }
h3 { font: 600 .9rem/1.4 var(--mono); }
a { color: inherit; }
:focus-visible { outline: 2px solid var(--unclear); outline-offset: 2px; }
button, input { font: inherit; color: inherit; background: var(--card);
  border: 1px solid var(--line); border-radius: .5rem; padding: .3rem .7rem; min-height: 2.25rem; }
button { cursor: pointer; white-space: nowrap; }
button:hover { border-color: var(--soft); }
:root:not(.js) :is(.tools, #theme) { display: none; }

.pass { --c: var(--pass); } .fail { --c: var(--fail); } .flaky { --c: var(--flaky); }
.deviation { --c: var(--deviation); } .error { --c: var(--error); }
.skipped { --c: var(--soft); } .inconclusive { --c: var(--unclear); }
.card { background: var(--card); border: 1px solid var(--line); border-radius: .75rem; }

.top { display: flex; gap: 1rem; align-items: flex-start; justify-content: space-between; }
.outcome { margin: 1.25rem 0; padding: 1rem 1.25rem 1.1rem 1.5rem;
  box-shadow: inset .35rem 0 var(--c); }
.outcome strong { display: block; font-size: 1.15rem; color: var(--c); }
.shares { display: flex; gap: 2px; height: .5rem; margin-top: .75rem; border-radius: 1rem;
  overflow: hidden; }
.shares span { background: var(--c); min-width: 3px; }
.facts { display: flex; flex-wrap: wrap; gap: .75rem 2.5rem; }
dt { color: var(--soft); font-size: .8rem; }
.jumps { display: flex; flex-wrap: wrap; gap: .25rem 1rem; margin-top: 1.25rem; padding: 0;
  list-style: none; }

.tools { position: sticky; top: 0; z-index: 1; display: flex; flex-wrap: wrap; gap: .5rem;
  align-items: center; margin: 0 -1.5rem 1rem; padding: .6rem 1.5rem .75rem;
  background: var(--paper); border-bottom: 1px solid var(--line); }
.tools input { flex: 1 1 14rem; min-width: 0; }
.filters { display: flex; gap: .4rem; }
.filters button { color: var(--c); border-radius: 2rem; }
.filters button[aria-pressed=true] { background: var(--c); border-color: var(--c);
  color: var(--card); }
.heading { display: flex; flex-wrap: wrap; gap: 0 1rem; align-items: baseline;
  margin: 2.5rem 0 .35rem; }
.heading h2 { margin: 0; }
.shown { color: var(--soft); }

.topic { margin: 0 0 1.25rem; overflow: clip; }
.topic > header { display: flex; gap: 1rem; justify-content: space-between; padding: .55rem 1rem;
  background: var(--sunk); border-bottom: 1px solid var(--line); }
.topic > header span { color: var(--soft); font-size: .85rem; white-space: nowrap; }
.row + .row { border-top: 1px solid var(--line); }
.row > summary { display: grid; gap: .15rem 1rem;
  grid-template-columns: 7.6rem minmax(0, 20rem) minmax(0, 1fr) auto .6rem;
  align-items: baseline; padding: .6rem 1rem; cursor: pointer; list-style: none; }
.row > summary::-webkit-details-marker { display: none; }
.row > summary::after { content: "\203A" / ""; color: var(--soft); font-size: 1.2rem;
  line-height: 1; justify-self: center; transition: rotate .12s; }
.row[open] > summary::after { rotate: 90deg; }
.row > summary:hover { background: var(--sunk); }
.row > summary:focus-visible { outline-offset: -2px; }
.verdict { justify-self: start; padding: .1rem .55rem; border-radius: 1rem; color: var(--c);
  background: color-mix(in srgb, var(--c) 13%, transparent); font-weight: 650; font-size: .72rem;
  letter-spacing: .04em; text-transform: uppercase; white-space: nowrap; }
.name { font: .87rem/1.5 var(--mono); }
.summary { color: var(--soft); }
.reason::before { content: "\2013\00A0"; }
.time { color: var(--soft); font-size: .82rem; font-variant-numeric: tabular-nums; }
.row[open] > summary .summary { color: inherit; }
.body { padding: .25rem 1rem 1.1rem; border-left: .2rem solid var(--c); margin: 0 0 .75rem 1rem;
  display: grid; grid-template-columns: minmax(0, 1fr); gap: .8rem; }
.body dl { display: grid; grid-template-columns: 6.6rem minmax(0, 1fr); gap: .3rem 1rem; }
.body dt { padding-top: .1rem; }
:is(.fail, .flaky, .error) .got { color: var(--c); }
.evidence > summary { cursor: pointer; color: var(--soft); font-size: .85rem; }
pre { margin-top: .4rem; padding: .75rem .9rem; background: var(--sunk);
  border: 1px solid var(--line); border-radius: .5rem; overflow-x: auto; overflow-wrap: normal;
  font: .8rem/1.55 var(--mono); }
.again { color: var(--soft); font-size: .85rem; }
.again pre { color: var(--ink); white-space: pre-wrap; overflow-wrap: anywhere; user-select: all; }

.words { max-width: 48rem; white-space: pre-line; margin-bottom: 1rem; }
.wide { overflow-x: auto; margin-bottom: 1rem; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums;
  overflow-wrap: normal; }
th, td { padding: .45rem 1rem; text-align: left; vertical-align: baseline; }
:is(th, td):not(.number) { min-width: 8rem; }
th { color: var(--soft); font-weight: 500; font-size: .85rem; background: var(--sunk); }
tr + tr td, tbody td { border-top: 1px solid var(--line); }
.number { text-align: right; white-space: nowrap; }

.plot { padding: 1rem 1.75rem 1rem 1.25rem; margin-bottom: 1.25rem; break-inside: avoid; }
figcaption { font-weight: 600; }
.legend { display: flex; flex-wrap: wrap; gap: .1rem 1.25rem; margin-top: .25rem;
  list-style: none; }
.legend li { display: flex; gap: .45rem; align-items: center; font-size: .88rem; }
.y-label, .x-label { color: var(--soft); font-size: .82rem; }
.y-label { margin: .75rem 0 .6rem; }
.x-label { text-align: right; }
.axes > svg { display: block; }
.axes svg { overflow: visible; }
.grid line { stroke: var(--line); shape-rendering: crispEdges; }
.ticks text { fill: var(--soft); font-size: 12px; font-variant-numeric: tabular-nums; }
.ticks .x { text-anchor: middle; } .ticks .y { text-anchor: end; }
.plot path { fill: none; stroke: var(--s); stroke-width: 1.75; stroke-linejoin: round;
  stroke-linecap: round; vector-effect: non-scaling-stroke; }
.plot .bars { fill: color-mix(in srgb, var(--s) 28%, transparent); stroke-width: 1; }
.plot .dots { stroke-width: 5; }
.s0, .s4 { --s: light-dark(#1f62c9, #78aefc); } .s1, .s5 { --s: light-dark(#c2500a, #ffa45c); }
.s2, .s6 { --s: light-dark(#0d7d6c, #4fd1bb); } .s3, .s7 { --s: light-dark(#9c2f8f, #eb92df); }
.line:is(.s4, .s5, .s6, .s7) { stroke-dasharray: 6 5; }
.scene svg { display: block; width: 100%; height: min(28rem, 100vw); touch-action: pan-y;
  cursor: grab; }
.plot.scene path { stroke: var(--line); stroke-width: 1; }
.plot.scene .trail { stroke: var(--s); stroke-width: 1.75; }
.plot.scene .sticks { stroke: var(--ink); stroke-width: 7; }
.scene circle { fill: var(--card); stroke: var(--ink); stroke-width: 2;
  vector-effect: non-scaling-stroke; }
.scene .tool { fill: var(--s); }
.player { display: flex; gap: .75rem; align-items: center; }
.player input { flex: 1; min-width: 0; padding: 0; accent-color: var(--unclear); }
.player output { min-width: 4.5rem; text-align: right; font-variant-numeric: tabular-nums; }
:root:not(.js) .scene :is(svg, .player, .x-label) { display: none; }
.timeline { scroll-margin-top: 1rem; }
.steer { display: flex; flex-wrap: wrap; gap: .4rem; align-items: center; margin: .6rem 0; }
.steer output { color: var(--soft); font-variant-numeric: tabular-nums; }
:root:not(.js) .steer { display: none; }
.track { display: grid; grid-template-columns: 10rem minmax(0, 1fr); gap: 0 1rem;
  margin-top: .5rem; }
.track h4 { margin: 0; font: 500 .82rem/1.4 inherit; color: var(--soft); font-size: .82rem; }
.track .legend { gap: 0 .8rem; margin: 0; padding: 0; }
.strip { position: relative; height: 1.5rem; background: var(--sunk); }
.chart .strip { height: 8rem; }
.plot .strip > svg { display: block; width: 100%; height: 100%; overflow: hidden; }
.strip span { position: absolute; left: .2rem; font-size: 11px; line-height: 1;
  color: var(--soft); background: var(--sunk); pointer-events: none; }
.strip .high { top: .15rem; } .strip .low { bottom: .15rem; }
.strip i { position: absolute; inset: 0 auto; width: 0; border-left: 1.5px solid var(--fail);
  pointer-events: none; }
.plot .strip .line { stroke-width: 1.25; }
.lane { --s: var(--unclear); } .lane.fail { --s: var(--fail); }
.plot .lane path { fill: color-mix(in srgb, var(--s) 30%, transparent); stroke-width: 2.5;
  stroke-linecap: butt; cursor: pointer; }
.lane a:is(:hover, :focus, .chosen) path { stroke: var(--ink); stroke-width: 4; }
.axis { position: relative; height: 1.2rem; font-size: 12px; color: var(--soft);
  font-variant-numeric: tabular-nums; }
.axis span { position: absolute; translate: -50%; white-space: nowrap; }
.messages { max-height: 32rem; overflow: auto; position: relative; }
.messages td { padding: .2rem .8rem; font: .8rem/1.5 var(--mono); overflow-wrap: anywhere; }
.messages td:not(:last-child) { white-space: nowrap; }
.messages thead th { position: sticky; top: 0; }
.messages tr { content-visibility: auto; contain-intrinsic-size: auto 1.6rem; }
tr:target, .messages tr.chosen { background: color-mix(in srgb, var(--unclear) 18%,
  transparent); }
.messages .fail td:last-child { color: var(--c); }
.no-data { padding: 4rem 0; text-align: center; color: var(--soft); }
footer { margin-top: 3rem; color: var(--soft); font-size: .82rem; }

@media (max-width: 48rem) {
  body { padding: 1.25rem 1rem 3rem; }
  .tools { margin: 0 -1rem 1rem; padding: .6rem 1rem; }
  .filters { flex-basis: 100%; order: 1; overflow-x: auto; margin: 0 -1rem; padding: 2px 1rem; }
  .row > summary { grid-template-columns: 1fr auto .6rem; padding: .7rem .9rem; }
  .row > summary .name, .row > summary .summary { grid-column: 1 / -1; }
  .row > summary .time { grid-row: 1; grid-column: 2; }
  .row > summary::after { grid-row: 1; grid-column: 3; }
  .body { margin-left: .6rem; padding: .1rem .8rem .8rem; }
  .body dl { grid-template-columns: 1fr; gap: 0; } .body dd { margin-bottom: .4rem; }
  .plot { padding: .9rem 1.1rem .9rem .9rem; }
  .track { grid-template-columns: minmax(0, 1fr); }
  .ticks .odd { display: none; }
}
@media print {
  :root { color-scheme: light !important; }
  body { max-width: none; padding: 0; font-size: 10pt; background: #fff; }
  .tools, #theme { display: none !important; }
  .messages { max-height: none; } .steer { display: none; }
  .row { break-inside: avoid; } .topic { overflow: visible; }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; }
}
)css";

inline constexpr std::string_view kScript = R"js(
(() => {
  const root = document.documentElement;
  const theme = document.getElementById('theme');
  const systemDark = matchMedia('(prefers-color-scheme: dark)');
  const isDark = () => (root.dataset.theme ?? (systemDark.matches ? 'dark' : 'light')) === 'dark';
  const nameTheme = () => { theme.textContent = isDark() ? 'Light' : 'Dark'; };
  const memory = (use) => { try { return use(localStorage); } catch { return null; } };
  const saved = memory((store) => store.getItem('armjig-theme'));
  if (saved === 'dark' || saved === 'light') root.dataset.theme = saved;
  theme.addEventListener('click', () => {
    root.dataset.theme = isDark() ? 'light' : 'dark';
    memory((store) => store.setItem('armjig-theme', root.dataset.theme));
    nameTheme();
  });
  systemDark.addEventListener('change', nameTheme);
  nameTheme();
  root.classList.add('js');

  const showScene = (figure) => {
    const { times, chains } = JSON.parse(figure.dataset.scene);
    const svg = figure.querySelector('svg');
    const [button, slider, clock] = figure.querySelectorAll('button, input, output');
    const points = (chain) => Array.from({ length: chain.length / 3 },
                                         (_, i) => chain.slice(3 * i, 3 * i + 3));
    const poses = chains.map(points);
    const trail = poses.map((pose) => pose.at(-1));
    const reach = Math.max(1, ...poses.flat().map((point) => Math.hypot(...point)));
    const floor = Array.from({ length: 49 }, (_, i) =>
        [reach * Math.cos(i * Math.PI / 24), reach * Math.sin(i * Math.PI / 24), 0]);
    const axes = [[[-reach, 0, 0], [reach, 0, 0]], [[0, -reach, 0], [0, reach, 0]]];
    let turn = -0.9, tilt = 0.4;
    const seen = ([x, y, z]) => {
      const depth = x * Math.sin(turn) + y * Math.cos(turn);
      return [x * Math.cos(turn) - y * Math.sin(turn),
              -(z * Math.cos(tilt) + depth * Math.sin(tilt))].map(Math.round);
    };
    const make = (name, kind) => {
      const element = document.createElementNS(svg.namespaceURI, name);
      element.setAttribute('class', kind);
      return svg.appendChild(element);
    };
    svg.setAttribute('viewBox', [-1.1, -1.1, 2.2, 1.7].map((side) => side * reach).join(' '));
    const lines = [floor, ...axes].map((line) => [make('path', 'ground'), line]);
    const path = make('path', 'trail s0');
    const sticks = make('path', 'sticks');
    const joints = poses[0].map((_, i) =>
        make('circle', i === poses[0].length - 1 ? 'tool s0' : 'joint'));
    for (const joint of joints) joint.setAttribute('r', reach / 60);
    const draw = (element, line) => element.setAttribute('d', 'M' + line.map(seen).join('L'));
    const show = () => {
      const pose = poses[slider.value];
      for (const [element, line] of lines) draw(element, line);
      draw(path, trail);
      draw(sticks, pose);
      pose.map(seen).forEach(([x, y], i) => {
        joints[i].setAttribute('cx', x);
        joints[i].setAttribute('cy', y);
      });
      clock.textContent = `${times[slider.value].toFixed(2)} s`;
    };
    let began = null;
    const stop = () => { began = null; button.textContent = 'Play'; };
    const step = (now) => {
      if (began === null) return;
      const next = times.findIndex((time) => time >= (now - began) / 1000);
      slider.value = next < 0 ? times.length - 1 : next;
      show();
      if (next < 0) stop(); else requestAnimationFrame(step);
    };
    button.addEventListener('click', () => {
      if (began !== null) return stop();
      const from = +slider.value === times.length - 1 ? 0 : times[slider.value];
      began = performance.now() - 1000 * from;
      button.textContent = 'Stop';
      requestAnimationFrame(step);
    });
    slider.max = times.length - 1;
    slider.addEventListener('input', () => { stop(); show(); });
    svg.addEventListener('pointermove', (event) => {
      if (event.buttons === 0) return;
      turn += event.movementX / 150;
      tilt = Math.min(1.5, Math.max(0, tilt + event.movementY / 150));
      show();
    });
    show();
  };
  document.querySelectorAll('.scene').forEach(showScene);

  const showTimeline = (figure) => {
    const length = +figure.dataset.seconds;
    const strips = [...figure.querySelectorAll('.strip')];
    const box = figure.querySelector('.messages');
    const plot = figure.querySelector('.plot');
    const clock = figure.querySelector('output');
    const axis = figure.querySelector('.axis');
    const rows = [...box.querySelectorAll('tbody tr')];
    const timeOf = (row) => +row.cells[0].textContent;
    const cursors = strips.map((strip) => strip.appendChild(document.createElement('i')));
    let from = 0, to = length, chosen = null;
    plot.tabIndex = 0;
    const show = () => {
      for (const strip of strips) {
        strip.firstElementChild.setAttribute('viewBox', `${from} 0 ${to - from} 1000`);
      }
      const rough = (to - from) / 6, power = 10 ** Math.floor(Math.log10(rough));
      const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough);
      const digits = Math.max(0, -Math.floor(Math.log10(step)));
      axis.replaceChildren();
      for (let n = Math.ceil(from / step); n * step <= to; ++n) {
        const tick = axis.appendChild(document.createElement('span'));
        tick.textContent = (n * step).toFixed(digits);
        tick.style.left = `${100 * (n * step - from) / (to - from)}%`;
      }
      const place = chosen === null ? -1 : (timeOf(chosen) - from) / (to - from);
      for (const cursor of cursors) {
        cursor.hidden = place < 0 || place > 1;
        cursor.style.left = `${100 * place}%`;
      }
      clock.textContent = chosen === null ? '' : `${timeOf(chosen).toFixed(6)} s`;
    };
    const look = (begin, span) => {
      const wide = Math.min(length, Math.max(span, length * 1e-6));
      from = Math.min(Math.max(0, begin), length - wide);
      to = from + wide;
      show();
    };
    const choose = (row) => {
      if (row === chosen) return;
      const links = (each) => figure.querySelectorAll(`.lane a[href="#${each.id}"]`);
      if (chosen) {
        chosen.classList.remove('chosen');
        for (const link of links(chosen)) link.classList.remove('chosen');
      }
      chosen = row;
      row.classList.add('chosen');
      for (const link of links(row)) link.classList.add('chosen');
      const time = timeOf(row), span = to - from;
      if (time < from || time > to) look(time - span / 2, span); else show();
    };
    const goTo = (row) => {
      choose(row);
      row.cells[0].firstElementChild.focus({ preventScroll: true });
      box.scrollTop = row.offsetTop - box.clientHeight / 2;
    };
    const keys = {
      '+': () => zoom(0.5), '=': () => zoom(0.5), '-': () => zoom(2),
      ArrowLeft: () => look(from - (to - from) / 4, to - from),
      ArrowRight: () => look(from + (to - from) / 4, to - from),
      0: () => look(0, length),
    };
    const zoom = (factor) => {
      const span = to - from, time = chosen === null ? -1 : timeOf(chosen);
      const middle = time >= from && time <= to ? time : (from + to) / 2;
      look(middle - (middle - from) * factor, span * factor);
    };
    for (const button of figure.querySelectorAll('.steer button')) {
      button.addEventListener('click', () => keys[button.dataset.key]());
    }
    plot.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
    plot.addEventListener('click', (event) => {
      const strip = event.target.closest('.strip');
      if (!strip) return;
      event.preventDefault();
      const link = event.target.closest('a');
      if (link) return goTo(document.getElementById(link.getAttribute('href').slice(1)));
      const sides = strip.getBoundingClientRect();
      const time = from + (event.clientX - sides.left) / sides.width * (to - from);
      const after = rows.findIndex((row) => timeOf(row) >= time);
      const near = after < 0 ? rows.length - 1 : after;
      if (near >= 0) goTo(rows[near]);
    });
    for (const kind of ['focusin', 'click']) {
      box.addEventListener(kind, (event) => {
        const row = event.target.closest('tbody tr');
        if (!row) return;
        if (kind === 'click') event.preventDefault();
        choose(row);
      });
    }
    box.addEventListener('keydown', (event) => {
      const next = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      const row = next && chosen ? rows[rows.indexOf(chosen) + next] : null;
      if (!row) return;
      event.preventDefault();
      goTo(row);
    });
    const named = location.hash && document.getElementById(location.hash.slice(1));
    if (rows.includes(named)) goTo(named); else show();
  };
  document.querySelectorAll('.timeline').forEach(showTimeline);

  const search = document.getElementById('search');
  if (!search) return;
  const rows = [...document.querySelectorAll('.row')];
  const topics = [...document.querySelectorAll('.topic')];
  const filters = [...document.querySelectorAll('.filters button')];
  const unfold = document.getElementById('unfold');
  const shown = document.getElementById('shown');
  const texts = new Map(rows.map((row) => [row, row.textContent.toLowerCase()]));
  const visible = () => rows.filter((row) => !row.hidden);
  const nameUnfold = () => {
    unfold.textContent = visible().some((row) => !row.open) ? 'Open all' : 'Close all';
  };
  const refresh = () => {
    const words = search.value.toLowerCase().split(/\s+/);
    const wanted = filters.filter((button) => button.ariaPressed === 'true')
                          .map((button) => button.dataset.verdict);
    for (const row of rows) {
      const isWanted = wanted.length === 0 || wanted.includes(row.dataset.verdict);
      row.hidden = !isWanted || !words.every((word) => texts.get(row).includes(word));
    }
    for (const topic of topics) topic.hidden = !topic.querySelector('.row:not([hidden])');
    const count = visible().length;
    shown.textContent = count === 0 ? 'Nothing matches.' : `${count} of ${rows.length} shown`;
    nameUnfold();
  };
  search.addEventListener('input', refresh);
  for (const button of filters) {
    button.addEventListener('click', () => {
      button.ariaPressed = button.ariaPressed === 'true' ? 'false' : 'true';
      refresh();
    });
  }
  unfold.addEventListener('click', () => {
    const open = visible().some((row) => !row.open);
    for (const row of visible()) row.open = open;
  });
  document.addEventListener('toggle', nameUnfold, true);
  document.addEventListener('keydown', (event) => {
    if (event.key === '/' && document.activeElement !== search) {
      event.preventDefault();
      search.focus();
    } else if (event.key === 'Escape' && document.activeElement === search) {
      search.value = '';
      refresh();
    }
  });
  addEventListener('beforeprint', () => { for (const row of visible()) row.open = true; });
  refresh();
})();
)js";

/// The policy lets no other script run, whatever a device wrote into the report.
/// tests/integration/report_page_test.py fails if it does not fit the script, and says what would.
inline constexpr std::string_view kScriptHash =
    "sha256-6ruNOiqOtiq2Gj8OZH7CyrpY1NLoiO85o1Xzwwc05Es=";

inline constexpr const char* kTemplate = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none';
 style-src 'unsafe-inline'; script-src '{{{script_hash}}}';
 img-src data:; base-uri 'none'; form-action 'none'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>{{headline}}{{title}}</title>
<style>{{{style}}}</style>
</head>
<body>
<header>
<div class="top"><h1>{{title}}</h1>
<button id="theme" type="button" title="Switch colours">Dark</button></div>
{{#has_rows}}
<div class="outcome card {{outcome}}"><strong>{{conclusion}}</strong> {{counts}}
<div class="shares" aria-hidden="true">
{{#shares}}<span class="{{verdict}}" style="flex-grow: {{count}}"></span>{{/shares}}
</div>
</div>
{{/has_rows}}
<dl class="facts">
{{#facts}}<div><dt>{{name}}</dt><dd>{{value}}</dd></div>
{{/facts}}
</dl>
{{#has_jumps}}
<nav aria-label="Parts of the report"><ul class="jumps">
{{#has_rows}}<li><a href="#checks">Checks</a></li>{{/has_rows}}
{{#sections}}<li><a href="#part-{{number}}">{{title}}</a></li>
{{/sections}}
</ul></nav>
{{/has_jumps}}
</header>
<main>
{{#has_rows}}
<section id="checks" aria-labelledby="checks-title">
<div class="heading"><h2 id="checks-title">Checks</h2>
<p id="shown" class="shown" role="status"></p></div>
<div class="tools" role="search">
<input id="search" type="search" placeholder="Search  ( / )" aria-label="Search in all checks"
 autocomplete="off" spellcheck="false">
<div class="filters" role="group" aria-label="Only these verdicts">
{{#shares}}
<button type="button" class="{{verdict}}" data-verdict="{{verdict}}"
 aria-pressed="false">{{counted}}</button>
{{/shares}}
</div>
<button id="unfold" type="button">Open all</button>
</div>
{{#topics}}
<section class="topic card">
<header><h3>{{name}}</h3><span>{{counts}}</span></header>
{{#rows}}
<details class="row {{verdict}}" data-verdict="{{verdict}}"{{#is_open}} open{{/is_open}}>
<summary><span class="verdict">{{verdict}}</span> <span class="name">{{name}}</span>
<span class="summary">{{summary}}{{#reason}} <span class="reason">{{text}}</span>{{/reason}}</span>
<span class="time">{{time}}</span></summary>
<div class="body">
{{#has_details}}
<dl>
{{#details}}<dt>{{label}}</dt><dd class="{{label}}">{{text}}</dd>
{{/details}}
</dl>
{{/has_details}}
{{#evidence}}
<details class="evidence"{{#is_short}} open{{/is_short}}>
<summary>last exchange, {{lines}}</summary><pre>{{text}}</pre></details>
{{/evidence}}
{{#repeat}}<div class="again">again<pre>{{text}}</pre></div>{{/repeat}}
</div>
</details>
{{/rows}}
</section>
{{/topics}}
</section>
{{/has_rows}}
{{#sections}}
<section aria-labelledby="part-{{number}}">
<h2 id="part-{{number}}">{{title}}</h2>
{{#text}}<p class="words">{{text}}</p>{{/text}}
{{#has_table}}
<div class="wide card"><table>
<thead><tr>
{{#columns}}<th scope="col"{{#is_number}} class="number"{{/is_number}}>{{cell}}</th>{{/columns}}
</tr></thead>
<tbody>
{{#lines}}
<tr{{#id}} id="{{id}}"{{/id}}>{{#cells}}<td{{#is_number}} class="number"{{/is_number}}>{{cell}}</td>{{/cells}}</tr>
{{/lines}}
</tbody></table></div>
{{/has_table}}
{{#plots}}{{{figure}}}{{/plots}}
</section>
{{/sections}}
</main>
<footer>armjig {{version}}{{#started}} &middot; started {{started}} UTC{{/started}}</footer>
<script>{{{script}}}</script>
</body>
</html>
)html";

}  // namespace armjig::page
