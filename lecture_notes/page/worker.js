// The worker of a page: runs one program from its first step to its last, hands pictures and rows of the
// history to the page, and listens to it between two steps. `program` is made by Emscripten.

let wake = null;   // ends the wait between two steps
let pace = null;   // of the page: {paused, ms}
let instance = null;

const make = (module, more) => program({
    instantiateWasm(imports, receive) {
        WebAssembly.instantiate(module, imports).then(receive);
        return {};
    },
    ...more
});

// What --help prints, the parameter table of the program.
async function help(module) {
    const lines = [];
    const asked = await make(module, {print: (line) => lines.push(line)});
    asked.callMain(["--help"]);
    return lines.join("\n");
}

async function run(module, kind, args) {
    let names = null;
    const read = (file) => instance.FS.readFile("/out/" + file, {encoding: "utf8"});
    const say = (line) => postMessage({line});
    instance = await make(module, {
        kind,
        picture: {axes: [], columns: {}},
        print: say,
        printErr: say,
        showPicture() {
            const columns = Object.values(instance.picture.columns);
            postMessage({picture: instance.picture}, columns.map((column) => column.numbers.buffer));
            instance.picture = {axes: [], columns: {}};
        },
        addRows(numbers, done) {
            if (!names) {
                const [first, second] = read("history.dat").split("\n", 2);
                const units = new Map(second.replace("# units: ", "").split(", ").map((pair) => pair.split(" ")));
                names = first.split(" ").map((name) => ({name, unit: units.get(name) ?? "1"}));
            }
            postMessage({rows: numbers, names, done}, [numbers.buffer]);
        },
        wait(ms) {
            return new Promise((resume) => {
                wake = resume;
                if (pace.paused) return;
                if (ms > 0) return void setTimeout(resume, ms);
                const soon = new MessageChannel();  // a timer would take 4 ms
                soon.port1.onmessage = () => { soon.port1.close(); resume(); };
                soon.port2.postMessage(0);
            });
        },
        end(status) {
            const there = (file) => instance.FS.analyzePath("/out/" + file).exists;
            postMessage({
                status,
                summary: there("summary.json") ? read("summary.json") : "",
                history: there("history.dat") ? read("history.dat") : ""
            });
        }
    });
    instance._set_pace(pace.paused, pace.ms);
    instance.callMain([...args, "--force", "--out", "/out"]);
    if (instance.FS.analyzePath("/out/case.toml").exists) postMessage({effective: read("case.toml")});
}

// What fails in a promise, the program out of memory for one, is told to the page as any other error.
addEventListener("unhandledrejection", ({reason}) => { if (reason?.name !== "ExitStatus") throw reason; });

onmessage = async ({data}) => {
    if (data.pace) {
        pace = data.pace;
        instance?._set_pace?.(pace.paused, pace.ms);
    }
    if (data.next) instance?._show_one_picture?.();
    if (data.run) {
        await run(data.module, data.kind, data.run);  // to its first wait
        if (data.wantsHelp) postMessage({help: await help(data.module)});
        return;
    }
    wake?.();
};
