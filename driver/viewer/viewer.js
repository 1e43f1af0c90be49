// SPDX-License-Identifier: GPL-3.0-or-later
// Shows the layers of a job side by side; the page is viewer.html, its data viewer.cpp's.
'use strict';
// What the layers have in common; they lie in chunks (see viewer.h).
const job = JSON.parse(document.getElementById('job').textContent);
const [rx, ry, rz] = job.detail_vx;
const [nx, ny] = job.size_px;
const voxels = [nx * rx, ny * ry];
const kRuler = 26;  // CSS pixels
const kMark = 16;   // likewise
const compared = job.target && job.enhance !== 'none';  // plain masks are not what is sent
const names = [
  ['target', 'Target', 'what we want'],
  ['plain', 'Plain mask', 'the target at the printer\u2019s pixels'],
  ['plainDifference', 'Plain mask, printed', ''],
  ['mask', 'Mask sent', job.enhance === 'none' ? 'not enhanced' : 'enhanced: ' + job.enhance],
  ['printed', 'Printed', 'what the printer model predicts'],
  ['difference', 'Difference', ''],
  ['color', 'Color', job.color_step > 1 ? 'one pixel in ' + job.color_step : 'as sent'],
].filter(([id]) => id === 'color' ? job.color_step > 0 : id === 'plainDifference' ? compared :
  job.target || !['target', 'plain', 'difference'].includes(id));

// --- unpacking -------------------------------------------------------------------------------

async function inflate(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// A picture is an array of rows; a row is the ascending places at which it flips.
function powder(height) { return Array.from({length: height}, () => []); }

// Reads what run_codec.h writes, each picture as changes to `reference`.
function reader(bytes) {
  let at = 0;
  const number = () => {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      const byte = bytes[at++];
      value |= (byte & 0x7f) << shift;
      if (byte < 0x80) return value >>> 0;
    }
  };
  const next = (reference) => reference.map((before) => {
    const head = number();
    if (head === 0) {
      return before.map((flip) => { const n = number(); return flip + ((n >>> 1) ^ -(n & 1)); });
    }
    const row = [];
    for (let i = 0, last = 0; i + 1 < head; ++i) row.push(last += number());
    return row;
  });
  next.more = () => at < bytes.length;
  return next;
}

const chunks = new Map();  // number -> promise of its layers
function chunk(number) {
  if (!chunks.has(number)) {
    if (chunks.size > 8) chunks.delete(chunks.keys().next().value);
    chunks.set(number, unpack(document.getElementById('chunk' + number).textContent));
  }
  return chunks.get(number);
}
async function unpack(text) {
  const next = reader(await inflate(text));
  const layers = [];
  let slice = powder(voxels[1]), plain = powder(ny), mask = plain, printed = slice;
  while (next.more()) {
    const layer = {target: [], color: null};
    if (job.target) {
      for (let s = 0; s < rz; ++s) layer.target.push(slice = next(slice));
      layer.plain = plain = next(plain);
      layer.mask = next(plain);
      layer.printed = next(slice);
      if (compared) layer.plainPrinted = next(slice);
    } else {
      layer.mask = mask = next(mask);
      layer.printed = printed = next(printed);
    }
    layers.push(layer);
  }
  return layers;
}
async function layerAt(index) {
  const layers = await chunk(Math.floor(index / job.chunk_layers));
  return layers[index % job.chunk_layers];
}
async function colorOf(layer, index) {
  if (!layer.color && job.color_step > 0) {
    const image = new Image();
    image.src = 'data:image/png;base64,' + document.getElementById('color' + index).textContent;
    await image.decode();
    layer.color = image;
  }
  return layer.color;
}

// --- what there is to see: runs of a color in voxels -----------------------------------------

const colors = {solid: [60, 66, 72], mask: [32, 38, 43], missing: [196, 48, 42],
                extra: [42, 98, 196], same: [176, 182, 187]};

// Calls take(first, last, state) for the runs of two rows; bit 0 of state is a's, bit 1 is b's.
function merged(a, b, take) {
  let i = 0, j = 0, last = 0;
  while (i < a.length || j < b.length) {
    const x = Math.min(i < a.length ? a[i] : Infinity, j < b.length ? b[j] : Infinity);
    if (x > last) take(last, x, (i & 1) | (j & 1) << 1);
    last = x;
    while (i < a.length && a[i] === x) ++i;
    while (j < b.length && b[j] === x) ++j;
  }
}

// Calls paint(y, first, last, color, weight) for all runs of row y of a view, in its own samples.
const sources = {
  target: {scale: [1, 1], rows: (layer, y, paint) => {
    for (const slice of layer.target) runs(slice[y], paint, colors.solid, 1 / rz);
  }},
  plain: {scale: [rx, ry], rows: (layer, y, paint) => runs(layer.plain[y], paint, colors.mask, 1)},
  mask: {scale: [rx, ry], rows: (layer, y, paint) => runs(layer.mask[y], paint, colors.mask, 1)},
  printed: {scale: [1, 1],
            rows: (layer, y, paint) => runs(layer.printed[y], paint, colors.solid, 1)},
  plainDifference: {scale: [1, 1], rows: (layer, y, paint) =>
    differences(layer, layer.plainPrinted[y], y, paint)},
  difference: {scale: [1, 1], rows: (layer, y, paint) =>
    differences(layer, layer.printed[y], y, paint)},
};
function differences(layer, printedRow, y, paint) {
  for (const slice of layer.target) {
    merged(slice[y], printedRow, (first, last, state) => {
      const color = [null, colors.missing, colors.extra, colors.same][state];
      if (color) paint(first, last, color, 1 / rz);
    });
  }
}
function runs(row, paint, color, weight) {
  for (let i = 0; i < row.length; i += 2) paint(row[i], row[i + 1], color, weight);
}

// --- drawing ---------------------------------------------------------------------------------

let index = 0;          // of the layer shown
let shown = null;       // its pictures
let zoom = 1;           // CSS pixels a mm
let center = [0, 0];    // mm in the job's box
const boxMm = [nx * job.pitch_mm[0], ny * job.pitch_mm[1]];
const views = [];
let mark = null;        // of the place that was flown to: mm in the job's box, and the layer

// Every screen pixel becomes the mean of what it covers; where it covers less than a sample, that
// sample, so that zoomed in the picture's own pixels are seen.
function drawRuns(view, image, left, top, mmPerPixel) {
  const source = sources[view.id];
  const pitch = [0, 1].map((a) => job.pitch_mm[a] / job.detail_vx[a] * source.scale[a]);
  const height = Math.round(voxels[1] / source.scale[1]);
  const width = image.width;
  const cover = new Float64Array(3 * (width + 1));
  const covered = new Float64Array(width + 1);
  const fine = mmPerPixel <= pitch[0];  // a sample is larger than a pixel
  const x = (place) => {
    const pixel = (place * pitch[0] - left) / mmPerPixel;
    return Math.min(width, Math.max(0, fine ? Math.ceil(pixel - 0.5) : pixel));
  };
  for (let row = 0; row < image.height; ++row) {
    const from = (top + row * mmPerPixel) / pitch[1];
    const to = (top + (row + 1) * mmPerPixel) / pitch[1];
    let first = Math.floor((from + to) / 2), last = first;
    if (to - from > 1) { first = Math.ceil(from - 0.5); last = Math.ceil(to - 0.5) - 1; }
    const rows = last - first + 1;
    cover.fill(0);
    covered.fill(0);
    const add = (pixel, part, color, weight) => {
      covered[pixel] += part * weight;
      for (let c = 0; c < 3; ++c) cover[3 * pixel + c] += part * weight * color[c];
    };
    for (let y = Math.max(0, first); y <= Math.min(height - 1, last); ++y) {
      source.rows(shown, y, (a, b, color, weight) => {
        const begin = x(a), end = x(b);
        if (begin >= end) return;
        weight /= rows;
        const i = Math.floor(begin), j = Math.floor(end);
        if (i === j) return add(i, end - begin, color, weight);
        add(i, i + 1 - begin, color, weight);
        for (let pixel = i + 1; pixel < j; ++pixel) add(pixel, 1, color, weight);
        if (end > j) add(j, end - j, color, weight);
      });
    }
    const inside = first < height && last >= 0;
    const begin = x(0), end = x(width_of(source));
    for (let pixel = 0; pixel < width; ++pixel) {
      const on = inside && pixel + 0.5 > begin && pixel + 0.5 < end;
      const powder = on ? 255 : 236;
      const share = Math.min(1, covered[pixel]);
      for (let c = 0; c < 3; ++c) {
        image.data[4 * (row * width + pixel) + c] =
          Math.round(cover[3 * pixel + c] + (1 - share) * powder);
      }
      image.data[4 * (row * width + pixel) + 3] = 255;
    }
  }
}
function width_of(source) { return Math.round(voxels[0] / source.scale[0]); }

function drawColor(view, context, left, top, mmPerPixel, width, height) {
  context.fillStyle = '#ececec';
  context.fillRect(0, 0, width, height);
  context.imageSmoothingEnabled = false;
  context.drawImage(shown.color, -left / mmPerPixel, -top / mmPerPixel,
                    shown.color.naturalWidth * job.color_step * job.pitch_mm[0] / mmPerPixel,
                    shown.color.naturalHeight * job.color_step * job.pitch_mm[1] / mmPerPixel);
}

// Marks at round millimetres of the bed.
function drawRulers(context, size, ratio, left, top, mmPerPixel) {
  const step = [1, 2, 5].flatMap((n) => [-2, -1, 0, 1, 2].map((p) => n * 10 ** p))
    .sort((a, b) => a - b).find((mm) => mm / mmPerPixel >= 56 * ratio) || 500;
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const ruler = kRuler * ratio;
  context.fillStyle = '#fff';
  context.fillRect(0, 0, size[0], ruler);
  context.fillRect(0, 0, ruler * 1.5, size[1]);
  context.fillStyle = '#5b646b';
  context.font = 11 * ratio + 'px system-ui, sans-serif';
  for (let axis = 0; axis < 2; ++axis) {
    const start = (axis === 0 ? left : top) + job.origin_mm[axis];
    const edge = axis === 0 ? ruler * 1.5 : ruler;
    for (let n = Math.ceil(start / step); ; ++n) {
      const at = (n * step - start) / mmPerPixel;
      if (at > size[axis]) break;
      if (at < edge) continue;
      const label = (n * step).toFixed(digits);
      if (axis === 0) {
        context.fillRect(at, ruler - 6 * ratio, ratio, 6 * ratio);
        context.fillText(label, at + 3 * ratio, ruler - 8 * ratio);
      } else {
        context.fillRect(ruler * 1.5 - 6 * ratio, at, 6 * ratio, ratio);
        context.fillText(label, 3 * ratio, at + 4 * ratio);
      }
    }
  }
  context.fillText('mm', 3 * ratio, ruler - 8 * ratio);
}

// The millimetres of the box that a canvas shows: its left and top, and those of a pixel.
function windowOf(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const mmPerPixel = 1 / (zoom * ratio);
  const middle = [(canvas.width + 1.5 * kRuler * ratio) / 2, (canvas.height + kRuler * ratio) / 2];
  return {ratio, mmPerPixel, left: center[0] - middle[0] * mmPerPixel,
          top: center[1] - middle[1] * mmPerPixel};
}

function draw() {
  if (!shown) return;
  for (const view of views) {
    const canvas = view.canvas;
    const ratio = window.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    if (width === 0 || height === 0) continue;
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const context = canvas.getContext('2d');
    const {left, top, mmPerPixel} = windowOf(canvas);
    if (view.id === 'color') {
      drawColor(view, context, left, top, mmPerPixel, width, height);
    } else {
      const image = context.createImageData(width, height);
      drawRuns(view, image, left, top, mmPerPixel);
      context.putImageData(image, 0, 0);
    }
    drawMark(context, ratio, left, top, mmPerPixel);
    drawRulers(context, [width, height], ratio, left, top, mmPerPixel);
  }
}
// A ring around the place that was flown to, on a white one so that it shows on any picture.
function drawMark(context, ratio, left, top, mmPerPixel) {
  if (!mark || mark.layer !== index) return;
  const [x, y] = [(mark.mm[0] - left) / mmPerPixel, (mark.mm[1] - top) / mmPerPixel];
  for (const [width, color] of [[5, '#fff'], [2, '#d07a00']]) {
    context.lineWidth = width * ratio;
    context.strokeStyle = color;
    context.beginPath();
    context.arc(x, y, kMark * ratio, 0, 2 * Math.PI);
    context.stroke();
  }
}

// Voxels of the layer that are missing and extra in a print, by those wanted.
function tellDifference(id, printed) {
  const view = views.find((v) => v.id === id);
  if (!view) return;
  let missing = 0, extra = 0, solid = 0;
  for (const slice of shown.target) {
    slice.forEach((row, y) => merged(row, printed[y], (first, last, state) => {
      if (state & 1) solid += last - first;
      if (state === 1) missing += last - first;
      if (state === 2) extra += last - first;
    }));
  }
  const share = (n) => solid === 0 ? n + ' voxels' : (100 * n / solid).toFixed(2) + ' %';
  view.note.innerHTML = `<span class="missing">missing ${share(missing)}</span> &middot; ` +
    `<span class="extra">extra ${share(extra)}</span>`;
}

// --- moving ----------------------------------------------------------------------------------

let wanted = -1;
async function show(layer) {
  wanted = Math.min(job.size_px[2] - 1, Math.max(0, layer));
  const mine = wanted;
  const pictures = await layerAt(mine);
  await colorOf(pictures, mine);
  if (mine !== wanted) return;  // a later one is on its way
  index = mine;
  shown = pictures;
  document.getElementById('slider').value = index + job.first;
  document.getElementById('number').value = index + job.first;
  history.replaceState(null, '', '#layer=' + (index + job.first));
  draw();
  tellDifference('plainDifference', shown.plainPrinted);
  tellDifference('difference', shown.printed);
  document.body.dataset.layer = index + job.first;  // drawn
}
function fit() {
  const canvas = views[0].canvas;
  zoom = 0.94 * Math.min((canvas.clientWidth - 1.5 * kRuler) / boxMm[0],
                         (canvas.clientHeight - kRuler) / boxMm[1]);
  center = [boxMm[0] / 2, boxMm[1] / 2];
  draw();
}
function zoomWithin(wish) {
  const most = 60 / Math.min(job.pitch_mm[0] / rx, job.pitch_mm[1] / ry);
  return Math.min(most, Math.max(0.5, wish));
}
// Shows the layer and the surroundings of a place: twice what is wrong, and at least 4 mm.
async function flyTo(place) {
  const canvas = views[0].canvas;
  center = [0, 1].map((axis) => place.at_mm[axis] - job.origin_mm[axis]);
  zoom = zoomWithin(Math.min(canvas.clientWidth / Math.max(4, 2 * place.size_mm[0]),
                             canvas.clientHeight / Math.max(4, 2 * place.size_mm[1])));
  mark = {mm: center, layer: place.layer - job.first};
  await show(mark.layer);
}
// Zooms so that the place under the pointer, or the middle, stays where it is.
function zoomBy(factor, at) {
  const next = zoomWithin(zoom * factor);
  at = at || center;
  for (let axis = 0; axis < 2; ++axis) {
    center[axis] = at[axis] + (center[axis] - at[axis]) * zoom / next;
  }
  zoom = next;
  draw();
}
function mmAt(canvas, event) {
  const {ratio, mmPerPixel, left, top} = windowOf(canvas);
  const box = canvas.getBoundingClientRect();
  return [left + (event.clientX - box.left) * ratio * mmPerPixel,
          top + (event.clientY - box.top) * ratio * mmPerPixel];
}
function tellPlace(mm) {
  const pixel = [0, 1].map((axis) => Math.floor(mm[axis] / job.pitch_mm[axis]));
  const inside = pixel.every((p, axis) => p >= 0 && p < job.size_px[axis]);
  const z = ((index + job.first) * job.pitch_mm[2]).toFixed(3);
  document.getElementById('where').textContent = !inside ? '' :
    `x ${(mm[0] + job.origin_mm[0]).toFixed(3)}  y ${(mm[1] + job.origin_mm[1]).toFixed(3)}  ` +
    `z ${z} mm   pixel ${pixel[0]}, ${pixel[1]}, layer ${index + job.first}`;
}

// What to look at first, as a list to click.
function buildPlaces() {
  const data = document.getElementById('places');
  const places = data ? JSON.parse(data.textContent) : [];
  const nav = document.getElementById('list');
  nav.hidden = places.length === 0;
  for (const place of places) {
    const button = document.createElement('button');
    button.textContent = place.say;
    const where = document.createElement('span');
    where.className = 'faint';
    where.textContent = `x ${place.at_mm[0].toFixed(1)}  y ${place.at_mm[1].toFixed(1)}  ` +
      `z ${place.at_mm[2].toFixed(1)} mm, layer ${place.layer}`;
    button.append(where);
    button.addEventListener('click', () => {
      for (const other of nav.querySelectorAll('button')) other.removeAttribute('aria-current');
      button.setAttribute('aria-current', 'true');
      flyTo(place);
    });
    const item = document.createElement('li');
    item.append(button);
    nav.querySelector('ol').append(item);
  }
}

function build() {
  buildPlaces();
  const main = document.getElementById('views');
  const columns = Math.min(names.length, 3);
  main.style.gridTemplate = `repeat(${Math.ceil(names.length / columns)}, minmax(0, 1fr)) / ` +
    `repeat(${columns}, minmax(0, 1fr))`;
  for (const [id, title, about] of names) {
    const figure = document.createElement('figure');
    figure.innerHTML = '<figcaption><b></b><span class="faint"></span></figcaption>' +
      '<div><canvas></canvas></div>';
    figure.querySelector('b').textContent = title;
    const note = figure.querySelector('span');
    note.textContent = about;
    const canvas = figure.querySelector('canvas');
    canvas.id = id;
    main.append(figure);
    views.push({id, canvas, note});
    let held = null;
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      zoomBy(Math.exp(-event.deltaY / 300), mmAt(canvas, event));
    }, {passive: false});
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      held = mmAt(canvas, event);
    });
    canvas.addEventListener('pointerup', () => { held = null; });
    canvas.addEventListener('pointermove', (event) => {
      const at = mmAt(canvas, event);
      if (held) {
        center = center.map((c, axis) => c + held[axis] - at[axis]);
        draw();
      }
      tellPlace(mmAt(canvas, event));
    });
  }
  document.title = job.name + ' \u2013 binderjet';
  document.getElementById('title').textContent = job.name;
  document.getElementById('about').textContent = job.about;
  const last = job.first + job.size_px[2] - 1;
  for (const id of ['slider', 'number']) {
    const input = document.getElementById(id);
    input.min = job.first;
    input.max = last;
    input.addEventListener('input', () => {
      if (input.value !== '') show(Number(input.value) - job.first);
    });
  }
  document.getElementById('up').addEventListener('click', () => show(wanted + 1));
  document.getElementById('down').addEventListener('click', () => show(wanted - 1));
  document.getElementById('fit').addEventListener('click', fit);
  const keys = {
    ArrowRight: () => show(wanted + 1), ArrowUp: () => show(wanted + 1),
    ArrowLeft: () => show(wanted - 1), ArrowDown: () => show(wanted - 1),
    PageUp: () => show(wanted + 10), PageDown: () => show(wanted - 10),
    Home: () => show(0), End: () => show(job.size_px[2] - 1),
    '+': () => zoomBy(1.5), '=': () => zoomBy(1.5), '-': () => zoomBy(1 / 1.5), '0': fit,
  };
  window.addEventListener('keydown', (event) => {
    if (event.target.id === 'number' && !event.key.startsWith('Page')) return;
    const act = keys[event.key];
    if (!act || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    act();
  });
  window.addEventListener('resize', draw);
  window.addEventListener('hashchange', fromAddress);
}
function fromAddress() {
  const named = /^#layer=(\d+)$/.exec(location.hash);
  return show(named ? Number(named[1]) - job.first : Math.floor(job.size_px[2] / 2));
}

if (typeof DecompressionStream === 'undefined') {
  document.getElementById('about').textContent =
    'This browser is too old for the page: it needs DecompressionStream (2023 or later).';
} else {
  build();
  fromAddress().then(fit);
}
