// helpers.js: what the scripts of pages share.
"use strict";
const $ = selector => document.querySelector(selector), pageData = JSON.parse($("#data").textContent);
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const written = value => String(value).replace("-", "−"), shortened = (v, digits = 12) => Number(v.toPrecision(digits));
// The least of 1, 2, 5, 10 … that is at least `least`.
function roundStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * [1, 2, 5, 10].find(n => n * power >= least);
}
function element(tag, attributes, ...inner) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...inner);
  return made;
}

// Values along an axis: from its start, 0, to its end, 1; and pixels.
const axisValue = ({ from, to, logarithmic }, share) =>
  logarithmic ? from * (to / from) ** share : from + (to - from) * share;
const axisShare = ({ from, to, logarithmic }, value) =>
  logarithmic ? Math.log(value / from) / Math.log(to / from) : (value - from) / (to - from);
const pixelAt = ({ start, end }, share) => start + (end - start) * share;
const shareAt = ({ start, end }, pixel) => (pixel - start) / (end - start);

// The address ends with numbers: #x=1&y=2.
const addressNumbers = () => Object.fromEntries([...new URLSearchParams(location.hash.slice(1))]
  .map(([key, text]) => [key, Number(text)]).filter(([, number]) => Number.isFinite(number)));
function keepAddress(numbers) {
  const hash = `#${new URLSearchParams(numbers)}`;
  try { history.replaceState(null, "", hash); } catch { /* a frame that has no address */ }
}

// Gives a canvas so many pixels of the page, at the screen's density.
function setSize(canvas, width, height) {
  [canvas.width, canvas.height] = [width, height].map(length => Math.max(1, Math.round(length * devicePixelRatio)));
}

// Keys with their actions, where no control that has the focus takes them, and, of a player, while it is shown.
function onKeys(actions, target = window) {
  target.addEventListener("keydown", event => {
    const { key, target: at } = event, isOfControl = at.matches("button, [type=checkbox]") ? [" ", "Enter"].includes(key)
      : at.matches("input:not([type=range]), select, textarea");
    const isHidden = target === window && $(".player")?.hidden, isOther = event.ctrlKey || event.metaKey || event.altKey;
    if (isOfControl || isHidden || isOther || event.defaultPrevented || !actions[key]) return;
    event.preventDefault();
    actions[key](event);
  });
}
