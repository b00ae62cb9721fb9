
"use strict";
// Shows the values of the curves that are switched on, under the pointer.
(() => {
  const readout = document.getElementById("readout");
  const cache = new Map();
  const pointsOf = (path) => {
    if (!cache.has(path)) {
      const numbers = path.getAttribute("d").split(/[MLV ]+/).filter(Boolean).map(Number);
      const size = path.classList.contains("stems") ? 3 : 2;
      const points = [];
      for (let i = 0; numbers.length - i >= size; i += size) {
        points.push([numbers[i], numbers[i + size - 1]]);
      }
      cache.set(path, points);
    }
    return cache.get(path);
  };
  const nearest = (points, x) => points.reduce((best, point) =>
    Math.abs(best[0] - x) > Math.abs(point[0] - x) ? point : best);
  const numbers = (area, name) => area.getAttribute(name).split(" ");
  const value = (area, y, height) => {
    const [low, high, kind] = numbers(area, "data-y");
    const share = 1 - y / height;
    if (kind === "log") return Number(low) * (Number(high) / Number(low)) ** share;
    return Number(low) + share * (Number(high) - Number(low));
  };
  const shown = (path) => getComputedStyle(path).display !== "none";
  const lines = (area, x, width, height) => {
    const [low, high] = numbers(area, "data-x").map(Number);
    const unit = area.getAttribute("data-unit");
    const all = [...area.querySelectorAll(".curve")].filter(shown);
    const values = all.map((path) => {
      const point = nearest(pointsOf(path), x);
      return path.getAttribute("data-name") + ": " +
        Number(value(area, point[1], height).toPrecision(3)) + " " + unit;
    });
    return ["at " + (low + (x / width) * (high - low)).toPrecision(4), ...values].join("\n");
  };
  const show = (event, text) => {
    readout.hidden = text === "";
    readout.textContent = text;
    const right = event.clientX + 220 > innerWidth ? event.clientX - 200 : event.clientX + 16;
    readout.style.left = right + "px";
    readout.style.top = event.clientY + 14 + "px";
  };
  for (const plot of document.querySelectorAll(".plot")) {
    plot.addEventListener("pointermove", (event) => {
      const at = new DOMPoint(event.clientX, event.clientY)
        .matrixTransform(plot.getScreenCTM().inverse());
      let text = "";
      for (const area of plot.querySelectorAll(".area")) {
        const [left, top, width, height] = numbers(area, "data-frame").map(Number);
        const [x, y] = [at.x - left, at.y - top];
        const inside = [x, y, width - x, height - y].every((distance) => distance >= 0);
        if (inside) text = lines(area, x, width, height);
      }
      show(event, text);
    });
    plot.addEventListener("pointerleave", (event) => show(event, ""));
  }
})();
