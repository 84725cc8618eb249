// The pictures: points, an image with contours, lines, and the history. Colors are those of page.css.

const palettes = {
    inferno: ["#000004", "#1b0c41", "#4a0c6b", "#781c6d", "#a52c60", "#cf4446", "#ed6925", "#fb9b06", "#f7d13d", "#fcffa4"],
    diverging: ["#053061", "#2166ac", "#4393c3", "#92c5de", "#f7f7f7", "#f4a582", "#d6604d", "#b2182b", "#67001f"]
};
const bytes = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const line_colors = () => [0, 1, 2, 3].map((k) => css(`--line-${k}`));

/// 256 colors, as the 32 bits of a pixel.
function table_of(palette) {
    const stops = palette.map(bytes);
    return Uint32Array.from({length: 256}, (_, n) => {
        const at = n / 255 * (stops.length - 1), k = Math.min(Math.floor(at), stops.length - 2);
        const [r, g, b] = stops[k].map((low, c) => Math.round(low + (at - k) * (stops[k + 1][c] - low)));
        return pixel(r, g, b);
    });
}
const pixel = (r, g, b) => (255 << 24 | b << 16 | g << 8 | r) >>> 0;

/// Fringes of one color: sin^2 of pi times the order, the stress difference over that of one fringe.
const fringes = Uint32Array.from({length: 256}, (_, n) => {
    const light = 0.012 + 0.988 * Math.sin(Math.PI * n / 256) ** 2;
    const shown = Math.round(255 * light ** (1 / 2.2));
    return pixel(shown, shown, Math.round(0.85 * shown));
});

/// Round numbers in [low, high], about `count` of them.
function ticks(low, high, count) {
    const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= raw);
    const all = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) all.push(+(k * step).toPrecision(12));
    return all;
}

// At a tick: 4e-4 is shorter than 0.0004, for which there is no room.
function number_at_tick(v) {
    const plain = String(v), short = v.toExponential().replace("e+", "e");
    return (plain.length > 5 && short.length < plain.length ? short : plain).replaceAll("-", "−");
}

/// A canvas as large as it is shown, with two axes. out: context, the rectangle of the data, and where x and y are in it
function frame(canvas, x, y, {log = false, equal = false} = {}) {
    const scale = window.devicePixelRatio || 1;
    if (equal) {  // no higher than the data
        const needed = (canvas.clientWidth - 70) * (y.high - y.low) / (x.high - x.low) + 50;
        if (needed < canvas.clientHeight - 1) canvas.style.height = `${needed}px`;
    }
    const width = Math.round(canvas.clientWidth * scale), height = Math.round(canvas.clientHeight * scale);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    const to = canvas.getContext("2d");
    to.clearRect(0, 0, width, height);
    const em = 13 * scale, ink = css("--ink");
    const box = {left: 4.6 * em, top: 0.8 * em, width: width - 5.4 * em, height: height - 3.6 * em};
    if (equal) {  // one length for both
        const unit = Math.min(box.width / (x.high - x.low), box.height / (y.high - y.low));
        box.width = unit * (x.high - x.low);
        box.height = unit * (y.high - y.low);
        box.left = Math.max(box.left, (width - box.width) / 2);
    }
    const f = log ? Math.log10 : (v) => v;
    const at_x = (v) => box.left + (v - x.low) / (x.high - x.low) * box.width;
    const at_y = (v) => box.top + box.height - (f(v) - f(y.low)) / (f(y.high) - f(y.low)) * box.height;
    to.font = `${em}px system-ui, "DejaVu Sans", sans-serif`;
    to.fillStyle = ink, to.strokeStyle = css("--faint"), to.lineWidth = scale;
    const label = (text, px, py, align, base) => Object.assign(to, {textAlign: align, textBaseline: base}) && to.fillText(text, px, py);
    for (const v of ticks(x.low, x.high, Math.max(2, box.width / (4.5 * em)))) label(number_at_tick(v), at_x(v), box.top + box.height + 0.5 * em, "center", "top");
    const decades = () => ticks(f(y.low), f(y.high), Math.max(2, box.height / (3 * em))).filter(Number.isInteger).map((k) => 10 ** k);
    for (const v of log ? decades() : ticks(y.low, y.high, Math.max(2, box.height / (3 * em)))) {
        label(log ? v.toExponential(0).replace("e+", "e") : number_at_tick(v), box.left - 0.5 * em, at_y(v), "right", "middle");
        to.beginPath(), to.moveTo(box.left, at_y(v)), to.lineTo(box.left + box.width, at_y(v)), to.stroke();
    }
    label(x.label, box.left + box.width / 2, box.top + box.height + 1.8 * em, "center", "top");
    to.save(), to.translate(Math.max(0.2 * em, box.left - 4.4 * em), box.top + box.height / 2), to.rotate(-Math.PI / 2);
    label(y.label, 0, 0, "center", "top");
    to.restore();
    to.strokeStyle = ink;
    to.beginPath(), to.moveTo(box.left, box.top), to.lineTo(box.left, box.top + box.height), to.lineTo(box.left + box.width, box.top + box.height), to.stroke();
    return {to, box, at_x, at_y, scale};
}

// Names and units as they are printed: omega_p^2 with Greek letters and powers.
const print = (text) => text.replaceAll("omega", "ω").replaceAll("Omega", "Ω").replaceAll("^2", "²").replaceAll("^3", "³").replaceAll("*", " ");
const with_unit = (name, unit) => unit && unit !== "1" && unit !== name ? `${name} [${print(unit)}]` : name;

function range_of(numbers) {
    let low = Infinity, high = -Infinity;
    for (const v of numbers) if (v < low || v > high) low = Math.min(low, v), high = Math.max(high, v);
    return [low, high];
}

/// A square of pixels for every particle.
function draw_points(canvas, picture, style, memory, effective) {
    const {[style.x]: X, [style.y]: Y, [style.color]: C} = picture.columns;
    const area = plane(picture, style, memory, effective);
    const {to, box, at_x, at_y, scale} = frame(canvas, area.x, area.y, style);
    const width = Math.floor(box.width), height = Math.floor(box.height);
    if (width < 1 || height < 1) return;
    const image = to.createImageData(width, height), data = new Uint32Array(image.data.buffer);
    const polarized = style.color === "fringes";
    const colors = line_colors().map((color) => pixel(...bytes(color)));
    const fringe = 0.03 * effective["material.default.E"];  // the stress difference of one
    if (polarized) data.fill(pixel(0, 0, 0));
    // Particles of a known volume are as large as that; others cover a part of the picture in all.
    const {V, s_xx, s_yy, s_xy} = picture.columns;
    const unit = width / (area.x.high - area.x.low);
    const shared = Math.sqrt(width * height / X.numbers.length / 2);
    let size = Math.round(Math.min(4 * scale, style.equal ? Math.max(2, shared * 1.5) : Math.max(1, shared / 2)));
    for (let p = 0; p < X.numbers.length; ++p) {
        if (V) size = Math.ceil(Math.sqrt(V.numbers[p]) * unit) + 1;
        const order = polarized ? Math.hypot(s_xx.numbers[p] - s_yy.numbers[p], 2 * s_xy.numbers[p]) / fringe : 0;
        const color = polarized ? fringes[Math.floor(256 * order) % 256] : colors[C.numbers[p] % colors.length];
        const i = Math.round(at_x(X.numbers[p]) - box.left - size / 2), j = Math.round(at_y(Y.numbers[p]) - box.top - size / 2);
        for (let b = Math.max(0, j); b < Math.min(height, j + size); ++b)
            for (let a = Math.max(0, i); a < Math.min(width, i + size); ++a) data[b * width + a] = color;
    }
    to.putImageData(image, Math.ceil(box.left), Math.floor(box.top));
}

/// The part of the plane that is shown: of the style, of the mesh, or of all pictures so far.
function plane(picture, style, memory, effective) {
    const axis = (name, low, high) => {
        const column = picture.columns[name];
        const [least, most] = range_of(column.numbers);
        const key = "range_" + name;
        const before = memory[key] ?? [least, most];
        memory[key] = [Math.min(before[0], least), Math.max(before[1], most)];
        return {low: low ?? memory[key][0], high: high ?? memory[key][1], label: with_unit(name, column.unit)};
    };
    const length = (letter) => {  // of the mesh along it
        if (!style.equal) return letter === "x" ? effective["grid.length_x"] : undefined;
        const given = effective[`grid.length_${letter}`];
        return given ?? effective["grid.length_x"] * effective[`grid.cells_${letter}`] / effective["grid.cells_x"];
    };
    const low = (letter) => effective[`grid.low_${letter}`] ?? 0;
    const span = (letter) => Number.isFinite(length(letter)) ? [low(letter), low(letter) + length(letter)] : [];
    return {x: axis(style.x, ...span(style.x)), y: axis(style.y, ...(style.equal ? span(style.y) : [style.y_low, style.y_high]))};
}

/// One column over a mesh in colors, with contour lines of another.
function draw_image(canvas, picture, style, memory) {
    const [x, z] = picture.axes, nx = x.count, nz = z.count;
    let values = picture.columns[style.value].numbers;
    if (style.less_mean) {
        values = values.slice();
        for (let j = 0; j < nz; ++j) {
            const mean = values.subarray(j * nx, (j + 1) * nx).reduce((sum, v) => sum + v, 0) / nx;
            for (let i = 0; i < nx; ++i) values[j * nx + i] -= mean;
        }
    }
    let [low, high] = range_of(values);
    if (style.palette === "diverging") memory.most = Math.max(memory.most ?? 0, high, -low), low = -memory.most, high = memory.most;
    if (style.from_zero) memory.most = Math.max(memory.most ?? 0, high), low = 0, high = memory.most;
    const span = (axis) => ({low: axis.low, high: axis.low + (axis.count - 1) * axis.step, label: with_unit(axis.name, axis.unit)});
    const {to, box, at_x, at_y, scale} = frame(canvas, span(x), span(z), style);
    const small = memory.small ??= document.createElement("canvas");
    Object.assign(small, {width: nx, height: nz});
    const image = new ImageData(nx, nz), data = new Uint32Array(image.data.buffer);
    const colors = memory.colors ??= table_of(palettes[style.palette]);
    for (let j = 0; j < nz; ++j)
        for (let i = 0; i < nx; ++i)
            data[(nz - 1 - j) * nx + i] = colors[Math.max(0, Math.min(255, Math.round(255 * (values[j * nx + i] - low) / (high - low || 1))))];
    small.getContext("2d").putImageData(image, 0, 0);
    to.imageSmoothingEnabled = true;
    to.drawImage(small, box.left, box.top, box.width, box.height);
    if (!style.contours) return;
    const A = picture.columns[style.contours].numbers;
    memory.levels ??= range_of(A);
    to.strokeStyle = "#ffffffb0", to.lineWidth = 1.2 * scale;
    const levels = Array.from({length: 15}, (_, k) => memory.levels[0] + (k + 1) / 16 * (memory.levels[1] - memory.levels[0]));
    to.beginPath();
    contour(A, nx, nz, levels, (i0, j0, i1, j1) => {
        to.moveTo(at_x(x.low + i0 * x.step), at_y(z.low + j0 * z.step));
        to.lineTo(at_x(x.low + i1 * x.step), at_y(z.low + j1 * z.step));
    });
    to.stroke();
}

/// Calls line(i0, j0, i1, j1) for the pieces of contour lines, two triangles in every cell.
function contour(A, nx, nz, levels, line) {
    for (let j = 0; j + 1 < nz; ++j)
        for (let i = 0; i + 1 < nx; ++i) {
            const n = j * nx + i;
            const low = Math.min(A[n], A[n + 1], A[n + nx], A[n + nx + 1]), high = Math.max(A[n], A[n + 1], A[n + nx], A[n + nx + 1]);
            for (const level of levels)
                if (low < level && level <= high)
                    for (const corners of [[[i, j], [i + 1, j], [i + 1, j + 1]], [[i, j], [i, j + 1], [i + 1, j + 1]]]) {
                        const ends = [];
                        for (let k = 0; k < 3; ++k) {
                            const [a, b] = [corners[k], corners[(k + 1) % 3]];
                            const [f, g] = [a, b].map(([p, q]) => A[q * nx + p] - level);
                            if (f < 0 !== g < 0) ends.push(a[0] + f / (f - g) * (b[0] - a[0]), a[1] + f / (f - g) * (b[1] - a[1]));
                        }
                        if (ends.length === 4) line(...ends);
                    }
        }
}

/// Columns of a mesh of one dimension.
function draw_lines(canvas, picture, style) {
    const x = picture.axes[0];
    const view = frame(canvas, {low: x.low, high: x.low + (x.count - 1) * x.step, label: with_unit(x.name, x.unit)},
                       {low: style.y_low, high: style.y_high, label: style.values.join(", ")});
    const colors = line_colors();
    style.values.forEach((name, k) => {
        const numbers = picture.columns[name].numbers;
        draw_line(view, Array.from(numbers, (_, i) => x.low + i * x.step), numbers, colors[k]);
    });
}

function draw_line({to, box, at_x, at_y, scale}, x, y, color, dashes = []) {
    to.save();
    to.beginPath(), to.rect(box.left, box.top, box.width, box.height), to.clip();
    to.strokeStyle = color, to.lineWidth = 2 * scale, to.setLineDash(dashes.map((d) => d * scale));
    to.beginPath();
    const every = Math.max(1, Math.floor(x.length / (2 * box.width)));
    for (let n = 0; n < x.length; n += every) to.lineTo(at_x(x[n]), at_y(y[n]));
    to.stroke();
    to.restore();
}

/// Columns of the history of one run or two, which is dashed.
function draw_chart(canvas, style, histories, end) {
    const lines = [], colors = line_colors();
    histories.forEach(({names, values}, r) => style.lines.forEach((name, k) => {
        if (!names) return;
        const column = (name) => {
            const c = names.findIndex((one) => one.name === name);
            return values.filter((_, n) => n % names.length === c);
        };
        let y = column(name);
        if (style.relative) y = y.map((v) => v / y[0]);
        if (style.log) y = y.map((v) => Math.max(v, 1e-300));
        lines.push({x: column(style.x), y, color: colors[histories.length > 1 ? r : k], dashes: r ? [6, 4] : [],
            unit: style.relative ? "over its first value" : names.find((one) => one.name === name).unit, x_unit: names.find((one) => one.name === style.x).unit});
    }));
    if (lines.length === 0) return;
    let [low, high] = range_of(lines.flatMap(({y}) => style.log ? y.filter((v) => v > 1e-30) : y));
    if (style.log) low = Math.max(low, high * 1e-12) * 0.8, high *= 1.5;
    else [low, high] = [Math.min(low, style.y_low ?? 0), Math.max(high, style.y_high ?? 0)];
    if (high === low) high = low + 1;
    const name = style.lines.length === 1 ? style.lines[0] : "energy";
    const last = Math.max(...lines.map(({x}) => x[x.length - 1]));
    const view = frame(canvas, {low: 0, high: Math.max(last, end || 0) || 1, label: with_unit(style.x, lines[0].x_unit)},
                       {low, high, label: name}, style);
    for (const {x, y, color, dashes} of lines) draw_line(view, x, y, color, dashes);
}

const draw_picture = {points: draw_points, image: draw_image, lines: draw_lines};
