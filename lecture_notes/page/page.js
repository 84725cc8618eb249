// A page: starts the programs of its case, draws what they hand over, and turns controls into parameters.
"use strict";

const page = cases[document.body.dataset.case];
const programs = {};  // filled by the scripts in programs/
const $ = (id) => document.getElementById(id);
const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
// Pictures per second of the positions of the slider; the last is as many as the program makes.
const speeds = [1, 2, 5, 10, 30, 60, Infinity];

const changed = new Map();  // parameters that the reader has set, by run and name
let runs = [], paused = calm;
const table = new Map();  // parameters of each program
const record = {first_picture: null, errors: []};  // for the test: when it was drawn, in ms

function element(tag, properties = {}, ...children) {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
}

const say = (text, bad = false) => {
    $("status").textContent = text;
    $("status").className = bad ? "bad" : "";
};

// ---- runs -----------------------------------------------------------------------------------------

function bytes_of(letters) {
    return Uint8Array.from(atob(letters), (letter) => letter.charCodeAt(0));
}

async function load(name) {
    await new Promise((done, fail) => document.head.append(element("script", {src: `programs/${name}.js`, onload: done, onerror: () => fail(`there is no programs/${name}.js`)})));
    const {script, wasm} = programs[name];
    programs[name] = {
        url: URL.createObjectURL(new Blob([bytes_of(script)], {type: "text/javascript"})),
        module: await WebAssembly.compile(bytes_of(wasm))
    };
}

const pace = () => ({paused, ms: 1000 / speeds[$("speed").value - 1]});

function start() {
    for (const run of runs) run.worker.terminate();
    $("results").querySelectorAll("table, .scroll").forEach((old) => old.remove());
    $("no-results").hidden = false;
    $("lines").textContent = "";
    $("progress").value = 0;
    say(paused ? "Paused at the start." : "Running.");
    runs = page.runs.map(({program, args}, r) => {
        const {url, module} = programs[program];
        const run = {
            program, worker: new Worker(url), canvas: $(`picture-${r}`), history: {names: null, values: []},
            memory: {}, effective: null, lines: [], picture: null, drawn: null, pictures: 0, done: 0, status: null
        };
        run.worker.onmessage = ({data}) => receive(run, data);
        run.worker.onerror = (event) => { record.errors.push(event.message); say(`${program}: ${event.message}`, true); };
        const settings = new Map([...changed].filter(([key]) => key.startsWith(`${r}:`)).map(([key, value]) => [key.slice(2), value]));
        const words = args.filter((arg) => !settings.has(arg.split("=")[0])).concat([...settings].map(([name, value]) => `${name}=${value}`));
        run.worker.postMessage({pace: pace(), module, kind: page.picture.kind, run: words, wantsHelp: !table.has(program)});
        return run;
    });
}

function receive(run, data) {
    if (data.line !== undefined) {
        run.lines.push(data.line);
        $("lines").textContent = runs.flatMap(({lines}) => lines).join("\n");
    }
    if (data.help) show_table(run.program, data.help);
    if (data.effective) {
        run.effective = parse_case(data.effective);
        show_values();
    }
    if (data.picture) {
        run.picture = data.picture;
    }
    if (data.rows) {
        run.history.names = data.names;
        for (const value of data.rows) run.history.values.push(value);
        run.done = data.done;
    }
    if (data.status !== undefined) end(run, data);
    redraw();
}

function end(run, {status, summary, history}) {
    Object.assign(run, {status, done: 1, text: history, summary: summary ? JSON.parse(summary) : null});
    // With the row that the program writes after its loop.
    if (run.history.names && history)
        run.history.values = history.trim().split("\n").slice(1).filter((row) => !row.startsWith("#")).flatMap((row) => row.split(" ").map(Number));
    if (run.summary) show_results(run);
    if (runs.some((one) => one.status === null)) return;
    const words = runs.map((one) => {
        const judged = Object.entries(one.summary?.results ?? {}).filter(([, result]) => result.verdict);
        const others = judged.filter(([, {verdict}]) => verdict !== "PASS").map(([name, {verdict}]) => `, ${name} ${verdict}`);
        const verdicts = judged.length ? `, ${judged.length - others.length} of ${judged.length} results PASS${others.join("")}` : "";
        return `${one.program}: ${one.status === 0 ? "done" : "ended with status " + one.status}${verdicts}`;
    });
    const failed = runs.filter((one) => one.status !== 0);
    const reasons = failed.map(({lines, program}) => lines.filter((line) => line.includes(`${program}: `)).pop() ?? "");
    say([...words, ...reasons].join(". "), failed.length > 0);
    $("pause").disabled = $("next").disabled = true;
}

// ---- pictures -------------------------------------------------------------------------------------

let drawing = false;
function redraw() {
    if (drawing) return;
    drawing = true;
    requestAnimationFrame(() => {
        drawing = false;
        for (const run of runs)
            if (run.picture && run.effective && run.picture !== run.drawn) {
                draw_picture[page.picture.draw](run.canvas, run.picture, page.picture, run.memory, run.effective);
                run.drawn = run.picture;
                ++run.pictures;
                record.first_picture ??= performance.now();
            }
        const histories = runs.map((run) => run.history);
        if (histories.some(({names}) => names)) draw_chart($("chart"), page.chart, histories, end_time());
        $("progress").value = Math.min(...runs.map((run) => run.done));
        for (const [r, run] of runs.entries()) {
            const {names, values} = run.history;
            const time = names ? values[values.length - names.length] : 0;
            run.canvas.setAttribute("aria-label", `${page.title}: ${run.program} at ${names?.[0].name ?? "time"} ${time.toPrecision(4)}`);
            $(`caption-${r}`).textContent = `${run.program}, ${names ? with_unit(names[0].name, names[0].unit) : "time"} = ${time.toPrecision(4)}`;
        }
    });
}

// Where the axis of the history ends, if it is that of the first column and known.
const end_time = () => page.chart.x === "time" ? runs[0].effective?.["time.end"] : undefined;

// Name by name beside a piece of its line; the second of two runs is dashed.
function keys(names, dashed = false) {
    return names.flatMap((name, k) => {
        const key = element("span", {className: dashed && k ? "key dashed" : "key"});
        key.style.borderTopColor = `var(--line-${k})`;
        return [key, name];
    });
}

function show_legend() {
    const {lines, relative} = page.chart, several = page.runs.length > 1;
    const what = several ? `${lines[0]}${relative ? " over its first value" : ""} of ` : "";
    $("legend").append(what, ...keys(several ? page.runs.map(({program}) => program) : lines, several));
    $("chart").setAttribute("aria-label", `history of ${lines.join(", ")}`);
    if (page.picture.draw === "lines") $("pictures").after(element("p", {}, ...keys(page.picture.values)));
}

// ---- parameters -----------------------------------------------------------------------------------

// The table that --help prints: two lines for each parameter.
function show_table(program, help) {
    const entries = new Map();
    let entry = null;
    for (const line of help.split("\n")) {
        const first = /^ {2}([\w.<>]+\.[\w<>]+) +(.*?)(?: \[([^\]]*)\])?$/.exec(line);
        const second = /^ {10,}(.*); default (.*)$/.exec(line);
        if (first) entry = {name: first[1], meaning: first[2], unit: first[3] ?? ""};
        if (second && entry) entries.set(entry.name, Object.assign(entry, {range: second[1], default: second[2]})), entry = null;
    }
    table.set(program, entries);
    if (table.size === new Set(page.runs.map((run) => run.program)).size) show_sliders();
}

const entry_of = (program, name) => table.get(program).get(name) ?? table.get(program).get(name.replace(/\.[^.]+\./, ".<name>."));

// Low and high end of "0 ... 1", "> 0" or ">= 0".
function limits(range) {
    const both = /^(\S+) (?:< )?\.\.\. (\S+)$/.exec(range), one = /^>=? (\S+)$/.exec(range);
    return both ? [Number(both[1]), Number(both[2])] : [one ? Number(one[1]) : -Infinity, Infinity];
}

function show_sliders() {
    for (const [n, [name, from, to, only]] of page.sliders.entries()) {
        const of = page.runs.map((_, r) => r).filter((r) => only === undefined || r === only);
        const entry = entry_of(page.runs[of[0]].program, name);
        const [low, high] = limits(entry.range);
        const whole = Number.isInteger(from) && Number.isInteger(to) && /cells|per_cell/.test(name);
        const slider = element("input", {
            type: "range", id: `slider-${n}`, min: Math.max(from, low), max: Math.min(to, high), step: whole ? 1 : "any"
        });
        slider.dataset.name = name, slider.dataset.run = of[0];
        slider.setAttribute("aria-describedby", `meaning-${n}`);
        const value = element("output", {id: `value-${n}`});
        slider.oninput = () => value.textContent = shown(slider.value, entry.unit);
        slider.onchange = () => set(of, name, +Number(slider.value).toPrecision(4));
        const owner = only === undefined ? "" : ` of ${page.runs[only].program}`;
        $("sliders").append(element("label", {className: "row", htmlFor: slider.id}, name + owner, value), slider,
                            element("p", {className: "meaning", id: `meaning-${n}`}, `${entry.meaning}; ${entry.range}`));
    }
    show_values();
}

const shown = (value, unit) => `${+Number(value).toPrecision(4)}${unit && unit !== "1" ? " " + print(unit) : ""}`;

function set(of, name, value) {
    for (const r of of) changed.set(`${r}:${name}`, value);
    begin_again();
}

// "[section]" and "key = value" of a complete case, as numbers or text by full name.
function parse_case(text) {
    const values = {};
    let section = "";
    for (const line of text.split("\n")) {
        const heading = /^\[(.*)\]$/.exec(line), setting = /^(\w+) = (.*)$/.exec(line);
        if (heading) section = heading[1] + ".";
        if (setting) values[section + setting[1]] = Number.isNaN(Number(setting[2])) ? setting[2].replace(/^"(.*)"$/, "$1") : Number(setting[2]);
    }
    return values;
}

// The values of the runs, in the sliders and in the table of all parameters.
function show_values() {
    for (const slider of $("sliders").querySelectorAll("input")) {
        const value = runs[slider.dataset.run].effective?.[slider.dataset.name];
        if (value === undefined) continue;
        slider.value = value;
        $(slider.id.replace("slider", "value")).textContent = shown(value, entry_of(runs[slider.dataset.run].program, slider.dataset.name).unit);
    }
    if ($("all").open) fill_table();
}

function fill_table() {
    const wanted = $("search").value.toLowerCase();
    const inputs = runs.flatMap((run, r) => Object.entries(run.effective ?? {}).flatMap(([name, value]) => {
        const entry = table.has(run.program) && entry_of(run.program, name);
        if (!entry || !`${name} ${entry.meaning}`.toLowerCase().includes(wanted)) return [];
        const input = element("input", {value: String(value), autocomplete: "off"});
        input.onchange = () => set([r], name, input.value);
        const owner = runs.length > 1 ? `${run.program}: ` : "";
        return element("label", {}, `${owner}${with_unit(name, entry.unit)}: ${entry.meaning}; ${entry.range}`, input);
    }));
    $("table").replaceChildren(...inputs);
}

// ---- results and code -----------------------------------------------------------------------------

function show_results({program, summary}) {
    const number = (value) => typeof value === "number" ? String(+value.toPrecision(6)) : value ?? "";
    const rows = Object.entries(summary.results).map(([name, one]) => {
        const expected = one.at_most !== undefined ? `≤ ${number(one.at_most)}` : one.at_least !== undefined ? `≥ ${number(one.at_least)}` : one.expected === undefined ? "" : `${number(one.expected)} ± ${number(one.tolerance ?? 0)}`;
        const verdict = element("td", {className: one.verdict ?? ""}, one.verdict ?? "");
        return element("tr", {}, element("th", {scope: "row"}, name), element("td", {}, `${number(one.value)} ${one.unit === "1" ? "" : print(one.unit ?? "")}`),
                       element("td", {}, expected), verdict, element("td", {}, one.source ?? ""));
    });
    const head = element("tr", {}, ...["result", "measured", "expected", "verdict", "source"].map((text) => element("th", {scope: "col"}, text)));
    const scroll = element("div", {className: "scroll", tabIndex: 0});
    scroll.setAttribute("role", "region");
    scroll.setAttribute("aria-label", `results of ${program}`);
    scroll.append(element("table", {}, element("caption", {}, program), element("thead", {}, head), element("tbody", {}, ...rows)));
    $("results").append(scroll);
    $("no-results").hidden = true;
}

function show_code() {
    const chapter = element("a", {href: `../../lecture_notes/${page.chapter}`}, "the chapter of the lecture notes");
    $("code").append(element("p", {}, "This is what runs here; why, says ", chapter, "."));
    for (const path of page.step.split(" ")) {
        const pre = element("pre", {tabIndex: 0});
        pre.setAttribute("aria-label", path);
        let inside = false;
        code[path].forEach((line, n) => {
            if (/\/\/ \[\/\w+\]/.test(line)) inside = false, pre.append("\n");
            if (inside) pre.append(element("span", {}, String(n + 1).padStart(4) + "  "), line + "\n");
            if (/^ *\/\/ \[\w+\]$/.test(line)) inside = true;
        });
        $("code").append(element("p", {}, element("a", {href: `../../${path}`}, path)), pre);
    }
}

// ---- the page -------------------------------------------------------------------------------------

const tell = (message) => { for (const run of runs) run.worker.postMessage(message); };

function begin_again() {
    $("pause").disabled = $("next").disabled = false;
    start();
}

function set_pause(value) {
    paused = value;
    $("pause").textContent = paused ? "Run" : "Pause";
    say(paused ? "Paused." : "Running.");
    tell({pace: pace()});
}

async function open_page() {
    document.title = page.title;
    $("title").textContent = page.title;
    $("words").textContent = page.words;
    $("pictures").className = page.runs.length > 1 ? "pair" : "";
    page.runs.forEach((_, r) => {
        const canvas = element("canvas", {id: `picture-${r}`, className: "picture"});
        canvas.setAttribute("role", "img");
        canvas.setAttribute("aria-label", page.title);
        $("pictures").append(element("figure", {}, canvas, element("figcaption", {id: `caption-${r}`})));
    });
    show_legend();
    show_code();
    $("pause").onclick = () => set_pause(!paused);
    $("next").onclick = () => { if (!paused) set_pause(true); else tell({next: true}); };
    $("reset").onclick = () => { changed.clear(); begin_again(); };
    $("speed").oninput = () => {
        const speed = speeds[$("speed").value - 1];
        $("speed-value").textContent = speed === Infinity ? "as fast as it goes" : `${speed} pictures a second`;
        $("speed").setAttribute("aria-valuetext", $("speed-value").textContent);
        tell({pace: pace()});
    };
    $("speed").oninput();
    $("pause").textContent = paused ? "Run" : "Pause";
    $("search").oninput = fill_table;
    $("all").ontoggle = show_values;
    for (const form of [$("sliders"), $("table")]) form.onsubmit = (event) => event.preventDefault();
    const anew = () => {
        for (const run of runs) Object.assign(run, {drawn: null}).canvas.style.height = "";
        redraw();
    };
    addEventListener("resize", anew);
    matchMedia("(prefers-color-scheme: dark)").onchange = anew;
    say("Loading.");
    try {
        await Promise.all([...new Set(page.runs.map(({program}) => program))].map(load));
        start();
    } catch (error) {
        record.errors.push(String(error));
        say(`The program cannot be loaded: ${error}`, true);
    }
}

open_page();
