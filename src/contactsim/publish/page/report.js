"use strict";
const byId = name => document.getElementById(name);
const all = (selector, root = document) => [...root.querySelectorAll(selector)];

// Light and dark: as the system has it, until the reader chooses.
const root = document.documentElement;
const setTheme = dark => {
  root.dataset.theme = dark ? "dark" : "light";
  byId("theme").setAttribute("aria-pressed", dark);
};
setTheme(matchMedia("(prefers-color-scheme: dark)").matches);
byId("theme").addEventListener("click", () => setTheme(root.dataset.theme !== "dark"));

// Verdicts shown. A link to a hidden statement shows all of them again.
const filters = all(".filter button");
const show = mark => {
  filters.forEach(one => one.setAttribute("aria-pressed", one.dataset.show === mark));
  all("#statements tbody tr").forEach(row => { row.hidden = mark !== "" && !row.classList.contains("row-" + mark); });
};
filters.forEach(button => button.addEventListener("click", () => show(button.dataset.show)));

// A link opens what it leads to.
const reveal = () => {
  const target = byId(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  if (target instanceof HTMLDetailsElement) target.open = true;
  if (target.hidden) show("");
  target.scrollIntoView();
};
addEventListener("hashchange", reveal);
addEventListener("beforeprint", () => all("details:not(.film)").forEach(one => { one.open = true; }));

// Films play where the system asks for no less motion; elsewhere the figure above is the still picture.
if (!matchMedia("(prefers-reduced-motion: reduce)").matches) all(".film").forEach(one => { one.open = true; });

// Search: every word must occur in the text of a figure, a statement or a study.
const entries = JSON.parse(byId("entries").textContent);
entries.forEach(entry => { entry.text = (entry.title + " " + entry.more).toLowerCase(); });
const MAX_HITS = 25;
byId("search").addEventListener("input", event => {
  const words = event.target.value.toLowerCase().split(/\s+/).filter(Boolean);
  const hits = words.length ? entries.filter(entry => words.every(word => entry.text.includes(word))) : [];
  byId("hits").replaceChildren(...hits.slice(0, MAX_HITS).map(entry => {
    const link = Object.assign(document.createElement("a"), {href: "#" + entry.place, textContent: entry.title});
    link.append(Object.assign(document.createElement("small"), {textContent: entry.kind}));
    const item = document.createElement("li");
    item.append(link);
    return item;
  }));
  byId("found").textContent = words.length ? hits.length + " found" : "";
  byId("contents").hidden = words.length > 0;
});

// Figures: the static picture gives way to the vector picture, which knows its points.
const shown = new Map();  // picture on the page: its points, and the size that their places count in
const unpack = async packed => {
  const bytes = Uint8Array.from(atob(packed), letter => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
};
const replacePixels = async image => {
  const text = await unpack(byId("vector-" + image.dataset.name).textContent);
  const picture = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
  const size = picture.getAttribute("viewBox").split(" ").slice(2).map(Number);
  shown.set(image, {curves: JSON.parse(picture.querySelector("desc").textContent), size});
  image.src = URL.createObjectURL(new Blob([text], {type: "image/svg+xml"}));
};
const loads = new Map();  // picture: the promise of its vector picture
const load = image => {
  if (!loads.has(image)) loads.set(image, replacePixels(image));
  return loads.get(image);
};
const pictures = all("figure img[data-name]");
const watch = new IntersectionObserver(seen => seen.filter(one => one.isIntersecting).forEach(one => load(one.target)),
  {rootMargin: "60%"});
pictures.forEach(image => watch.observe(image));

// Value and error of the point next to the cursor.
const REACH = 24;  // pixels
const tip = byId("tip"), ring = byId("ring");
const hideTip = () => { tip.hidden = ring.hidden = true; };
const pictureFrame = (image, size) => {  // the picture inside its element, which may be wider or higher
  const box = image.getBoundingClientRect(), scale = Math.min(box.width / size[0], box.height / size[1]);
  return {scale, left: box.left + (box.width - scale * size[0]) / 2, top: box.top + (box.height - scale * size[1]) / 2};
};
const nearest = (image, event) => {
  const {curves, size} = shown.get(image), frame = pictureFrame(image, size);
  let best = null, least = REACH;
  curves.forEach(curve => curve.places.forEach(([across, down], index) => {
    const left = frame.left + frame.scale * across, top = frame.top + frame.scale * down;
    const distance = Math.hypot(left - event.clientX, top - event.clientY);
    if (distance < least) { least = distance; best = {curve, index, left, top}; }
  }));
  return best;
};
const line = (kind, text) => {  // indices and powers stand between braces
  const element = document.createElement(kind);
  text.split(/([_^]\{[^{}]*\})/).forEach(part => element.append(/^[_^]\{/.test(part)
    ? Object.assign(document.createElement(part[0] === "_" ? "sub" : "sup"), {textContent: part.slice(2, -1)}) : part));
  return element;
};
const showTip = (image, event) => {
  const point = shown.has(image) && nearest(image, event);
  if (!point) { hideTip(); return; }
  const {curve, index, left, top} = point;
  const values = [curve.x, curve.y, ...(curve.values ? [curve.values] : [])]
    .map((texts, axis) => line("span", curve.axes[axis] + ": " + texts[index]));
  tip.replaceChildren(...(curve.name ? [line("b", curve.name)] : []), ...values);
  tip.hidden = ring.hidden = false;
  ring.style.cssText = `left: ${left}px; top: ${top}px; border-color: ${curve.colour}`;
  const width = tip.offsetWidth, height = tip.offsetHeight;
  tip.style.left = Math.max(4, Math.min(left + 14, innerWidth - width - 4)) + "px";
  tip.style.top = (top + 14 + height > innerHeight ? top - 14 - height : top + 14) + "px";
};
addEventListener("scroll", hideTip, {passive: true});

// A figure by itself: wheel, pinch or + and − zoom, dragging pans.
const dialog = byId("large"), stage = dialog.querySelector(".stage"), large = dialog.querySelector("img");
const zoom = Panzoom(large, {maxScale: 12, minScale: 1, contain: "outside", panOnlyWhenZoomed: true, canvas: true});
stage.addEventListener("wheel", zoom.zoomWithWheel);
large.addEventListener("panzoomchange", hideTip);
const enlarge = image => {
  Object.assign(large, {src: image.src, alt: image.alt});
  shown.set(large, shown.get(image));
  zoom.reset({animate: false});
  dialog.showModal();
  dialog.append(tip, ring);  // only what is inside a modal dialog is seen above it
};
dialog.addEventListener("close", () => { hideTip(); document.body.append(tip, ring); });
byId("closer").addEventListener("click", () => zoom.zoomIn());
byId("farther").addEventListener("click", () => zoom.zoomOut());
byId("whole").addEventListener("click", () => zoom.reset());
byId("back").addEventListener("click", () => dialog.close());
const STEP = 60;
const MOVES = {ArrowLeft: [STEP, 0], ArrowRight: [-STEP, 0], ArrowUp: [0, STEP], ArrowDown: [0, -STEP]};
dialog.addEventListener("keydown", event => {
  if (event.key === "+" || event.key === "=") zoom.zoomIn();
  else if (event.key === "-") zoom.zoomOut();
  else if (event.key === "0") zoom.reset();
  else if (event.key in MOVES) zoom.pan(...MOVES[event.key], {relative: true});
  else return;
  event.preventDefault();
});
all("figure button.zoom").forEach(button => button.addEventListener("click", async () => {
  const image = button.querySelector("img");
  await load(image);
  enlarge(image);
}));
[...pictures, large].forEach(image => {
  image.addEventListener("pointermove", event => showTip(image, event));
  image.addEventListener("pointerleave", hideTip);
});
reveal();
