"use strict";
const preset = /slider=([0-9.]+)/.exec(location.hash);
for (const section of document.querySelectorAll("section.differs")) {
  const pictures = [...section.querySelectorAll("img")], pixels = pictures.map(picture => picture.getAttribute("width"));
  pictures.forEach((picture, i) => picture.style.setProperty("--part", pixels[i] / Math.max(...pixels)));  // all at one scale
  for (const button of section.querySelectorAll("figure button"))
    button.onclick = () => button.setAttribute("aria-expanded", button.closest("figure").classList.toggle("wide"));
  const slider = section.querySelector(".slider");
  if (!slider) continue;
  for (const element of [slider, slider.previousElementSibling])
    for (const side of ["width", "height"]) element.style.setProperty("--" + side, pictures[0].getAttribute(side));
  const range = slider.querySelector("input");
  for (const kind of ["actual", "expected"]) {
    const picture = section.querySelector("img." + kind).cloneNode();
    picture.alt = "";
    slider.insertBefore(picture, range);
  }
  const show = () => {
    slider.style.setProperty("--at", range.value + "%");
    range.setAttribute("aria-valuetext", Math.round(range.value) + " % expected, the rest actual");
  };
  range.oninput = show;
  if (preset) range.value = preset[1];
  show();
  slider.hidden = slider.previousElementSibling.hidden = false;
}
