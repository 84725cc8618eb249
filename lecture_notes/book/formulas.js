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
