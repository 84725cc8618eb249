// formulas.js: formulas by KaTeX, at build time, so that a page needs no script to show them.
//
//   node formulas.js check NOTE.md ...    renders every formula of the notes, and refuses what GitHub
//                                         does not show; status 1 with file and line
//   require('./formulas').render(tex, display)
'use strict';
const fs = require('fs');

const places = ['/usr/share/nodejs/katex/dist', '/usr/share/javascript/katex',
    '/usr/lib/node_modules/katex/dist'];
const folder = places.find((place) => fs.existsSync(place + '/katex.js'));

function render(tex, display) {
    const katex = require(folder + '/katex.js');
    // htmlAndMathml would write each formula twice.
    return katex.renderToString(tex, {displayMode: display, throwOnError: true, strict: 'error',
        output: 'html'});
}

// What GitHub's pages do not show, and what to write instead.
const refused = [
    [/\\(operatorname|mbox|phantom|newcommand|def|let|href|require|unicode|class|style)\b/,
        'a macro that GitHub does not allow; \\mathrm or \\text may do'],
    [/\\[^a-zA-Z\s]/, 'GitHub takes the backslash away before punctuation; write \\thinspace, \\lbrace, \\cr'],
    [/\*/, 'may begin emphasis; write \\ast'],
    [/<[a-zA-Z\/!]/, 'may begin an HTML tag; leave a space after <'],
    [/\]\(/, 'looks like a link; leave a space'],
];

// The text with everything that is no prose blanked out, so that lines and columns stay.
function prose(text) {
    const blank = (piece) => piece.replace(/[^\n]/g, ' ');
    return text.replace(/^(```+)[^\n]*\n[\s\S]*?^\1[^\n]*$/gm, blank)
        .replace(/^ {4,}\S.*$/gm, blank)
        .replace(/<!--[\s\S]*?-->/g, blank)
        .replace(/(`+)[^`\n]+\1/g, blank);
}

// Underscores that Markdown would take for emphasis: one that may begin it, and a later one in the same paragraph
// that may end it. A space before the second keeps it from ending anything, and no formula minds.
function emphasized(text) {
    const mark = (c) => /[!-\/:-@[-`{-~]/.test(c), space = (c) => !c || /\s/.test(c);
    const found = [];
    let begun = false;
    for (const {0: piece, index: at} of text.matchAll(/_|\n\s*\n|\|/g)) {
        if (piece !== '_') {
            begun = begun && piece === '|' && !/^\|/.test(text.slice(text.lastIndexOf('\n', at) + 1));
            continue;
        }
        const a = text[at - 1], b = text[at + 1];
        const left = !space(b) && (!mark(b) || space(a) || mark(a));
        const right = !space(a) && (!mark(a) || space(b) || mark(b));
        if (begun && right && (!left || mark(b))) found.push(at);
        begun = begun || (left && (!right || mark(a)));
    }
    return found;
}

function check(path) {
    const text = prose(fs.readFileSync(path, 'utf8'));
    const formula = /\$\$([\s\S]+?)\$\$|\$((?:[^$\n]|\n(?!\n))+?)\$/g;
    let faults = 0, count = 0;
    for (let found; (found = formula.exec(text));) {
        const line = text.slice(0, found.index).split('\n').length;
        const display = found[1] !== undefined, tex = display ? found[1] : found[2];
        const complain = (why) => {
            console.log(`${path}:${line}: ${why}: ${tex.trim()}`);
            faults++;
        };
        count++;
        for (const [pattern, why] of refused) if (pattern.test(tex)) complain(why);
        if (tex.includes('|') && text.split('\n')[line - 1].startsWith('|')) complain('| ends a cell of a table; write \\vert');
        const before = text[found.index - 1] || ' ', after = text[formula.lastIndex] || ' ';
        if (!display && /\w/.test(before)) complain('GitHub shows no formula after a letter or a digit');
        if (!display && /\w/.test(after)) complain('GitHub shows no formula before a letter or a digit');
        if (!display && /^\s|\s$/.test(tex)) complain('a formula begins or ends with a space');
        if (!display && /\\tag/.test(tex)) complain('a number belongs to a formula on its own line');
        try {
            render(tex, display);
        } catch (error) {
            complain(error.message);
        }
    }
    for (const at of emphasized(text)) {
        console.log(`${path}:${text.slice(0, at).split('\n').length}: Markdown may take this for the end of emphasis; ` +
            `write a space before the underscore: ${text.slice(Math.max(0, at - 20), at + 10).replace(/\n/g, ' ')}`);
        faults++;
    }
    if (/\$/.test(text.replace(formula, ''))) {
        console.log(`${path}: a $ has no partner`);
        faults++;
    }
    return {faults, count};
}

module.exports = {render, folder};

if (require.main === module) {
    if (process.argv[2] !== 'check' || process.argv.length < 4) {
        console.error('usage: node formulas.js check NOTE.md ...');
        process.exit(2);
    }
    if (!folder) {
        console.error("KaTeX is not installed: run 'make deps-book'");
        process.exit(2);
    }
    let faults = 0, count = 0;
    for (const path of process.argv.slice(3)) {
        const found = check(path);
        faults += found.faults;
        count += found.count;
    }
    console.log(`${count} formulas rendered`);
    process.exit(faults ? 1 : 0);
}
