// The pages in a real browser: node lecture_notes/page/test.mjs [case ...], from the root of the project.
//
// Chromium without a window is driven through a pipe (DevTools protocol). Every page is loaded from its
// file, timed, run to the end and compared with the native program; nothing may be asked of any host.
import {spawn, spawnSync} from "node:child_process";
import {mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, readdirSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join, resolve} from "node:path";
import vm from "node:vm";

// How many digits a history shares with that of the native program, of the largest number of the same unit, and
// until when if not to the end: particles that meet in a knot of orbits, or change cells, part in time.
const agreement = {
    two_stream: {digits: 9, until: 25}, landau: {digits: 9}, finite_grid: {digits: 9, until: 20}, sod: {digits: 9}, rayleigh_taylor: {digits: 6, until: 1},
    rebound: {digits: 6}, compressed: {digits: 6, until: 0.05}, gem: {digits: 4, until: 10}
};
const longest_s = 900;        // of a whole run
const patience_s = 60;        // for what takes a blink where nothing else computes
const first_picture_ms = 3000, least_pictures_per_s = 10, largest_file = 5e6;

const {cases} = vm.runInNewContext(readFileSync("lecture_notes/page/cases.js", "utf8").replace("const cases", "var cases") + "; ({cases})");
const shots = "build/web/screenshots";
mkdirSync(shots, {recursive: true});
const scratch = mkdtempSync(join(tmpdir(), "pages-"));
const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

let failures = 0;
function check(holds, sentence) {
    if (!holds) ++failures;
    console.log(`${holds ? "ok  " : "FAIL"} ${sentence}`);
}

// ---- the browser ----------------------------------------------------------------------------------

const browser = spawn("chromium", ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--remote-debugging-pipe", `--user-data-dir=${scratch}/profile`, "about:blank"],
                      {stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"]});
const answers = new Map();
const listeners = new Set();
let asked = 0, rest = "";
browser.stdio[4].setEncoding("utf8").on("data", (text) => {
    const messages = (rest + text).split("\0");
    rest = messages.pop();
    for (const message of messages.map((one) => JSON.parse(one))) {
        if (message.id === undefined) for (const listen of listeners) listen(message);
        else answers.get(message.id)?.(message);
        answers.delete(message.id);
    }
});
function ask(method, params = {}, sessionId = undefined) {
    const id = ++asked;
    browser.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + "\0");
    return new Promise((done, fail) => answers.set(id, (message) => message.error ? fail(new Error(`${method}: ${message.error.message}`)) : done(message.result)));
}

async function open(file, width, height) {
    const {targetId} = await ask("Target.createTarget", {url: "about:blank"});
    const {sessionId} = await ask("Target.attachToTarget", {targetId, flatten: true});
    const tab = {requests: [], complaints: [], ask: (method, params) => ask(method, params, sessionId), close: () => { listeners.delete(listen); return ask("Target.closeTarget", {targetId}); }};
    function listen({method, params, sessionId: from}) {
        if (from !== sessionId) return;
        if (method === "Network.requestWillBeSent") tab.requests.push(params.request.url);
        if (method === "Runtime.consoleAPICalled") tab.complaints.push(params.args.map((one) => one.value ?? one.description).join(" "));
        if (method === "Runtime.exceptionThrown") tab.complaints.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
        if (method === "Log.entryAdded") tab.complaints.push(params.entry.text);
    }
    listeners.add(listen);
    for (const domain of ["Page", "Runtime", "Network", "Log", "Accessibility"]) await tab.ask(`${domain}.enable`);
    tab.value = async (expression) => {
        const {result, exceptionDetails} = await tab.ask("Runtime.evaluate", {expression, returnByValue: true, awaitPromise: true});
        if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
        return result.value;
    };
    tab.size = (w, h) => tab.ask("Emulation.setDeviceMetricsOverride", {width: w, height: h, deviceScaleFactor: 1, mobile: w < 500});
    tab.picture = async (name) => {
        await tab.value("scrollTo(0, 0)");
        await sleep(300);
        const {data} = await tab.ask("Page.captureScreenshot", {format: "png", captureBeyondViewport: false});
        writeFileSync(`${shots}/${name}.png`, Buffer.from(data, "base64"));
    };
    await tab.size(width, height);
    await tab.ask("Page.navigate", {url: `file://${resolve(file)}`});
    return tab;
}

// Seconds that pages have computed since then, on all cores together: what other programs do on this machine has no part in it.
async function renderers() {
    const {processInfo} = await ask("SystemInfo.getProcessInfo");
    return new Map(processInfo.filter(({type}) => type === "renderer").map(({id, cpuTime}) => [id, cpuTime]));
}
async function computed_since(then) {
    return [...await renderers()].reduce((sum, [id, seconds]) => sum + seconds - (then.get(id) ?? 0), 0);
}

async function until(condition, seconds) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end; await sleep(100)) if (await condition()) return true;
    return false;
}

// ---- what every page must do ----------------------------------------------------------------------

function history_of(text) {
    const [first, second, ...rows] = text.trim().split("\n"), names = first.split(" ");
    const units = new Map(second.replace("# units: ", "").split(", ").map((pair) => pair.split(" ")));
    return {names, units: names.map((name) => units.get(name) ?? "1"), rows: rows.map((line) => line.split(" ").map(Number))};
}

// Digits shared by two histories up to a time: of the difference over the largest number of the same unit.
// out: of the column that shares the fewest, and its name
function shared_digits(here, native, last) {
    const rows = native.rows.filter(([time]) => time <= last);
    let least = {digits: here.rows.length === native.rows.length || last < Infinity ? 17 : 0, name: "the number of rows"};
    const largest = new Map();
    native.units.forEach((unit, c) => largest.set(unit, Math.max(largest.get(unit) ?? 0, ...rows.map((row) => Math.abs(row[c])))));
    native.names.forEach((name, c) => {
        const size = largest.get(native.units[c]);
        // Errors that are round-off, and counts, have no digits in common.
        if (size < 1e-9 || /error|residual|drift|divergence|^iterations|^loops|^contacts$/.test(name)) return;
        const most = Math.max(...rows.map((row, n) => Math.abs(row[c] - (here.rows[n]?.[c] ?? NaN))));
        const digits = Number.isNaN(most) ? 0 : Math.min(17, -Math.log10(most / size));
        if (digits < least.digits) least = {digits, name};
    });
    return least;
}

// Tab reaches every control, and every control has a name.
async function check_access(tab, name) {
    const {nodes} = await tab.ask("Accessibility.getFullAXTree");
    const controls = nodes.filter((node) => !node.ignored && ["button", "slider", "searchbox", "textbox", "link", "progressbar", "image", "figure"].includes(node.role?.value));
    const nameless = controls.filter((node) => node.role.value !== "figure" && !node.name?.value).map((node) => node.role.value);
    check(controls.length > 8 && nameless.length === 0, `${name}: all ${controls.length} controls and pictures have names ${nameless}`);
    const wanted = await tab.value(`(() => { document.activeElement.blur();
        return [...document.querySelectorAll("button, input, a, summary")].filter((one) => one.checkVisibility() && !one.disabled && !one.closest("details:not([open]) form")).length; })()`);
    const reached = new Set();
    for (let n = 0; n < wanted + 12; ++n) {
        for (const type of ["rawKeyDown", "keyUp"]) await tab.ask("Input.dispatchKeyEvent", {type, key: "Tab", code: "Tab", windowsVirtualKeyCode: 9});
        reached.add(await tab.value(`(() => { const one = document.activeElement; return /^(BUTTON|INPUT|A|SUMMARY)$/.test(one.tagName) ? one.id || one.textContent : ""; })()`));
    }
    reached.delete("");
    check(reached.size >= wanted, `${name}: Tab reaches ${reached.size} of ${wanted} controls`);
}

async function check_pause(tab, name) {
    await tab.value(`document.getElementById("pause").click()`);
    await sleep(500);
    const [before, time] = await tab.value(`[runs[0].pictures, runs[0].history.values.length]`);
    await sleep(500);
    const [after, later] = await tab.value(`[runs[0].pictures, runs[0].history.values.length]`);
    check(after === before && later === time, `${name}: stands still while paused`);
    await tab.value(`document.getElementById("next").click()`);
    await until(() => tab.value(`runs[0].pictures > ${before}`), patience_s);
    await sleep(300);
    check(await tab.value(`runs[0].pictures`) === before + 1, `${name}: goes one picture further with Step`);
    await tab.value(`document.getElementById("pause").click()`);
}

// A slider reaches the program, an impossible value is refused in words, and Reset takes both back.
async function check_parameters(tab, name) {
    const [parameter, value, before] = await tab.value(`(() => { const slider = document.querySelector("#sliders input");
        const before = runs[slider.dataset.run].effective[slider.dataset.name];
        slider.value = slider.max; slider.oninput(); slider.onchange();
        return [slider.dataset.name, Number(slider.value), before]; })()`);
    const arrives = (wanted) => until(() => tab.value(`runs.some((run) => run.effective?.["${parameter}"] === ${wanted})`), patience_s);
    check(value !== before && await arrives(value), `${name}: the slider sets ${parameter} = ${value}`);
    await tab.value(`set([0], "${parameter}", "nonsense")`);
    await until(() => tab.value(`runs[0].status !== null`), patience_s);
    check(await tab.value(`runs[0].status === 2 && runs[0].lines.some((line) => line.includes("${parameter}"))`), `${name}: nonsense is refused with a sentence`);
    await tab.value(`document.getElementById("reset").click()`);
    check(await arrives(before), `${name}: Reset takes it back to ${before}`);
}

// Who asks for less motion gets one picture, and a page that waits; who asks for the dark, dark.
async function check_wishes(name) {
    const tab = await open("out/web/index.html", 1280, 900);
    await tab.ask("Emulation.setEmulatedMedia", {features: [{name: "prefers-reduced-motion", value: "reduce"}, {name: "prefers-color-scheme", value: "dark"}]});
    await tab.ask("Page.navigate", {url: `file://${resolve(`out/web/${name}.html`)}`});
    await until(() => tab.value(`typeof record === "object" && record.first_picture !== null`), patience_s);
    await sleep(1000);
    check(await tab.value(`paused && runs.every((run) => run.pictures === 1)`), `${name}: starts paused, with one picture, for who asks for less motion`);
    await tab.value(`document.getElementById("pause").click()`);
    check(await until(() => tab.value(`runs[0].pictures > 5`), patience_s), `${name}: and goes on with Run`);
    await tab.picture(`${name}_dark`);
    await tab.close();
}

async function check_page(name) {
    const before = await renderers();
    const tab = await open(`out/web/${name}.html`, 1280, 900);
    await until(() => tab.value(`typeof record === "object" && record.first_picture !== null`), patience_s);
    const first = await tab.value(`record.first_picture`);
    const work = 1000 * await computed_since(before);
    check(first !== null && Math.min(first, work) < first_picture_ms, `${name}: first picture after ${Math.round(work)} ms of computing, ${Math.round(first)} ms as it was`);
    if (first === null) return void check(false, `${name}: ${tab.complaints} ${await tab.value(`runs.flatMap((run) => run.lines).join(" ")`)}`);
    await until(() => tab.value(`document.querySelector("#sliders input") !== null`), patience_s);
    const sliders = await tab.value(`document.querySelectorAll("#sliders input").length`);
    check(sliders === cases[name].sliders.length, `${name}: ${sliders} sliders from the parameter table`);

    const count = `Math.min(...runs.map((run) => run.pictures))`;
    await sleep(500);
    const [from, at] = [await tab.value(count), await renderers()];
    await sleep(3000);
    const [to, seconds] = [await tab.value(count), await computed_since(at)];
    const rate = (to - from) / seconds;
    check(rate >= least_pictures_per_s, `${name}: ${rate.toFixed(1)} pictures in a second of computing, ${((to - from) / 3).toFixed(1)} in a second as it was`);
    await check_pause(tab, name);
    await check_access(tab, name);
    await tab.picture(`${name}_running`);
    await check_parameters(tab, name);
    await tab.value(`(() => { const speed = document.getElementById("speed"); speed.value = speed.max; speed.oninput(); })()`);
    const start = Date.now();
    const ended = await until(() => tab.value(`runs.every((run) => run.status !== null)`), longest_s);
    check(ended, `${name}: ends (${((Date.now() - start) / 1000).toFixed(1)} s more at full speed)`);

    for (const [r, {program, args}] of cases[name].runs.entries()) {
        const [text, summary, status] = await tab.value(`[runs[${r}].text, runs[${r}].summary, runs[${r}].status]`);
        const native_start = Date.now();
        const native = spawnSync(`build/${program}`, [...args.filter((arg) => !arg.startsWith("output.") || arg.includes("_v_")), "--threads", "1", "--quiet", "--out", `${scratch}/${name}_${r}`]);
        const seconds = (Date.now() - native_start) / 1000;
        check(native.status === status, `${name}: ${program} ends with status ${status}, as the native one, which takes ${seconds.toFixed(1)} s`);
        const there = history_of(readFileSync(`${scratch}/${name}_${r}/history.dat`, "utf8"));
        const {digits, until: last = Infinity} = agreement[name];
        const least = text ? shared_digits(history_of(text), there, last) : {digits: 0, name: "no history"};
        check(least.digits >= digits, `${name}: history of ${program} as native to ${least.digits.toFixed(1)} digits or more${last < Infinity ? ` until ${last}` : ""}, the fewest in ${least.name} (at least ${digits})`);
        const [here_last, there_last] = [text ? history_of(text) : there, there].map(({names, rows}) => rows[rows.length - 1][names.indexOf("energy")]);
        const change = Math.abs(here_last / there_last - 1);
        check(change < 0.01, `${name}: energy of ${program} at the end as native but for ${change.toExponential(0)}`);
        const verdicts = (of) => Object.entries(of?.results ?? {}).map(([key, one]) => `${key} ${one.verdict ?? "-"}`).join(", ");
        const native_summary = JSON.parse(readFileSync(`${scratch}/${name}_${r}/summary.json`, "utf8"));
        check(verdicts(summary) === verdicts(native_summary), `${name}: verdicts of ${program} as native: ${verdicts(summary)}`);
    }
    const rows = await tab.value(`document.querySelectorAll("#results tbody tr").length`);
    const results = await tab.value(`runs.reduce((sum, run) => sum + Object.keys(run.summary?.results ?? {}).length, 0)`);
    check(rows === results, `${name}: the table has ${rows} results`);
    const short = await tab.value(`runs.flatMap(({program, text, history: {names, values}}) => {
        const [drawn, last] = [values[values.length - names.length], Number(text.trim().split("\\n").pop().split(" ")[0])];
        return drawn === last ? [] : [program + " at " + drawn + " of " + last]; })`);
    check(short.length === 0, `${name}: the chart ends where the run does ${short}`);
    const spoken = await tab.value(`document.getElementById("status").textContent`);
    check(/done/.test(spoken), `${name}: says at the end "${spoken}"`);
    await tab.picture(`${name}_end`);
    await tab.size(390, 844);
    await tab.picture(`${name}_phone`);
    const wide = await tab.value(`document.documentElement.scrollWidth`);
    check(wide <= 390, `${name}: ${wide} pixels wide on a phone`);
    const foreign = tab.requests.filter((url) => !/^(file|blob|data):/.test(url));
    check(tab.requests.length > 0 && foreign.length === 0, `${name}: asks no host (${tab.requests.length} requests of files) ${foreign}`);
    check(tab.complaints.length === 0, `${name}: no complaint on the console ${tab.complaints}`);
    await tab.close();
}

try {
    const names = process.argv.slice(2).length > 0 ? process.argv.slice(2) : Object.keys(cases);
    const files = readdirSync("out/web", {recursive: true}).map((file) => [file, statSync(join("out/web", file)).size]);
    const [largest, size] = files.reduce((one, other) => one[1] > other[1] ? one : other);
    check(size < largest_file, `the largest file is ${largest}, ${(size / 1e6).toFixed(2)} MB`);
    const index = await open("out/web/index.html", 1280, 900);
    await until(() => index.value(`document.readyState === "complete"`), 10);
    check(await index.value(`document.querySelectorAll("#cases a").length`) === Object.keys(cases).length, "the index names all pages");
    await index.picture("index");
    await index.close();
    await check_wishes(names[0]);
    for (const name of names) await check_page(name);
} finally {
    browser.kill();
    await new Promise((done) => browser.on("exit", done));
    rmSync(scratch, {recursive: true, force: true});
}
console.log(failures === 0 ? "all pages are well" : `${failures} checks failed`);
process.exit(failures === 0 ? 0 : 1);
