// finish.js OUT PRINT: what needs all pages of the book at once.
//   formulas become HTML; the places of the terms of the index; the index of the search; one page
//   with everything, PRINT, for the PDF. Ends with status 1 on a formula that does not render, a
//   link that leads nowhere, an anchor that is there twice, and a figure of the talk that is missing.
'use strict';
const fs = require('fs');
const {render} = require('./formulas.js');
const [out, print] = process.argv.slice(2);
const pages = fs.readFileSync('build/book/pages', 'utf8').trim().split('\n')
    .map((line) => line.split(' ')).map(([note, page]) => ({note, page}));
let faults = 0;
function complain(message) {
    console.error(message);
    faults++;
}

const plain = (html) => html.replace(/<[^>]*>/g, '').replace(/&lt;/g, '<').replace(/&gt;/g, '>')
    .replace(/&quot;/g, '"').replace(/&#39;/g, "'").replace(/&nbsp;/g, ' ').replace(/&amp;/g, '&');
const body = (html) => html.match(/<main[^>]*>([\s\S]*)<p class="turn">/)[1];

// ---- formulas, and the text of every section ----
const sections = [];
for (const page of pages) {
    const path = `${out}/${page.page}`;
    let html = fs.readFileSync(path, 'utf8');
    const words = body(html).replace(/<(pre|figcaption)[\s\S]*?<\/\1>/g, ' ')
        .replace(/<span class="math[^>]*>([\s\S]*?)<\/span>/g, (all, tex) => tex.replace(
            /\\(mathbf|boldsymbol|mathrm|text|t?frac|thinspace|q?quad|left|right|[Bb]ig|tag)\b/g, ' ').replace(/[\\{}]/g, ''));
    const title = plain((html.match(/<h1[^>]*>([\s\S]*?)<\/h1>/) || ['', page.page])[1]);
    for (const part of words.split(/(?=<h[123][ >])/)) {
        const heading = part.match(/^<h[123](?: id="([^"]*)")?[^>]*>([\s\S]*?)<\/h[123]>/);
        if (!heading) continue;
        const name = plain(heading[2]);
        sections.push({name, url: page.page + (heading[1] ? '#' + heading[1] : ''), page: page.page,
            title: name === title ? name : `${title}: ${name}`,
            text: plain(part.slice(heading[0].length)).replace(/\s+/g, ' ').trim()});
    }
    // A mark behind a formula goes into its last box, or a line might begin with it.
    html = html.replace(/<span class="math (inline|display)">([\s\S]*?)<\/span>([,.;:)]*)/g, (all, kind, tex, mark) => {
        try {
            const shown = render(plain(tex), kind === 'display');
            if (kind === 'display' || !mark) return shown + mark;
            return shown.replace(/(<\/span>){3}$/, `<span class="mark">${mark}</span>$&`);
        } catch (error) {
            complain(`${page.note}: ${error.message}: ${plain(tex)}`);
            return all;
        }
    });
    page.html = html;
}
fs.writeFileSync(`${out}/search_index.js`, 'window.searchIndex = ' + JSON.stringify(
    sections.map(({url, title, text}) => ({url, title, text}))) + ';\n');

// ---- the index: where the terms of terms.txt are, chapters only ----
const terms = fs.readFileSync('lecture_notes/book/terms.txt', 'utf8').trim().split('\n')
    .filter((line) => !line.startsWith('#'));
const entries = terms.map((line) => {
    const [name, ...others] = line.split('|').map((word) => word.trim());
    const pattern = new RegExp('\\b(' + [name, ...others].map((word) => word.replace(/[.*+?^${}()[\]\\]/g, '\\$&')
        .replace(/\s+/g, '\\s+')).join('|') + ')', 'i');
    const places = sections.filter((section) => /^0/.test(section.page) &&
        !/^(Exercises|Symbols|The ledger|Projects)$/.test(section.name) &&
        (pattern.test(section.title) || pattern.test(section.text)));
    if (!places.length) complain(`lecture_notes/book/terms.txt: "${name}" is in no chapter`);
    // The sections that say it most often, and any that has it in its title.
    const weight = (section) => (section.title.match(new RegExp(pattern, 'gi')) || []).length * 10 +
        (section.text.match(new RegExp(pattern, 'gi')) || []).length;
    const best = places.map((section) => [weight(section), section]).sort((a, b) => b[0] - a[0]).slice(0, 5)
        .map(([, section]) => section).sort((a, b) => sections.indexOf(a) - sections.indexOf(b));
    return `<p>${name}: ` + best.map((section) =>
        `<a href="${section.url}">${section.name}</a>`).join(', ') + '</p>';
});
for (const page of pages)
    page.html = page.html.replace('<p>@INDEX@</p>', `<div class="columns">${entries.join('\n')}</div>`);

// ---- links ----
const anchors = new Map();
for (const {page, html} of pages) {
    const found = [...html.matchAll(/ id="([^"]*)"/g)].map((match) => match[1]);
    anchors.set(page, new Set(found));
    for (const id of found.filter((id, i) => found.indexOf(id) !== i)) complain(`${page}: the anchor ${id} is there twice`);
}
let links = 0;
for (const {page, html} of pages) {
    for (const [, target] of html.matchAll(/ (?:href|src)="([^"]*)"/g)) {
        if (/^(https?:|data:)/.test(target)) continue;
        links++;
        const [file, anchor] = target.split('#').map(decodeURIComponent);
        if (file && !fs.existsSync(`${out}/${file}`)) complain(`${page}: there is no ${file}`);
        else if (anchor && anchors.has(file || page) && !anchors.get(file || page).has(anchor))
            complain(`${page}: ${file || page} has no anchor ${anchor}`);
    }
}
const figures = [...Array(15).keys()].map((i) => 'fig' + String(i + 1).padStart(2, '0')).concat('fig_cost');
for (const figure of figures)
    if (!pages.some(({html}) => html.includes(`id="figure-${figure}"`))) complain(`no page shows ${figure}`);

// ---- everything on one page, without sources: links to these become text ----
const printed = pages.filter(({page}) => !/^(source_|cases_|facts|index\.html)/.test(page));
const inPrint = new Set(printed.map(({page}) => page));
const name = (page, anchor) => page.replace('.html', '') + (anchor ? '--' + anchor : '');
const answers = [];  // on paper they stand at the end
const chapters = printed.map(({page, html}) => {
    const text = body(html)
        .replace(/ id="([^"]*)"/g, (all, id) => ` id="${name(page, id)}"`)
        .replace(/<a href="(?!https?:)([^"#]*)#?([^"]*)"([^>]*)>([\s\S]*?)<\/a>/g, (all, file, anchor, more, inside) =>
            inPrint.has(file || page) ? `<a href="#${name(file || page, anchor)}"${more}>${inside}</a>` : inside)
        .replace(/<a id="([^"]*--([^"]*))"><\/a>((?:(?!<a id=)[\s\S])*?)<details><summary>Answer<\/summary>([\s\S]*?)<\/details>/g,
            (all, id, exercise, question, answer) => {
                answers.push(`<h3 id="answer-${exercise}">Answer to <a href="#${id}">${exercise}</a></h3>${answer}`);
                return `<a id="${id}"></a>${question}<p><a href="#answer-${exercise}">Answer</a></p>`;
            })
        .replace(/<details>/g, '<details open>');
    return `<section class="chapter" id="${name(page)}">${text}</section>`;
});
const front = pages.find(({page}) => page === 'index.html').html;
const titles = new Map(fs.readFileSync('build/book/titles', 'utf8').trim().split('\n')
    .map((line) => line.split('\t')).map(([page, , title]) => [page, title]));
const contents = printed.map(({page}) => `<li><a href="#${name(page)}">${titles.get(page)}</a><i></i></li>`).join('\n');
fs.writeFileSync(print, front.replace(/<nav>[\s\S]*<\/nav>/, '').replace(/<script[\s\S]*?<\/script>/, '')
    .replace(/<input[^>]*>\s*<label[\s\S]*?<\/label>/, '')
    .replace(/(<main[^>]*>)[\s\S]*<\/main>/, (all, main) => `${main}<div class="cover">
<h1>The particle-in-cell family in running code</h1>
<p>Lecture notes to J. U. Brackbill's talk<br><em>The First Half Century of the Particle-in-Cell Method</em> (2002)</p></div>
<section class="chapter contents"><h1>Contents</h1><ul>${contents}<li><a href="#answers">Answers</a><i></i></li></ul></section>${chapters.join('\n')}
<section class="chapter" id="answers"><h1>Answers</h1>${answers.join('\n')}</section></main>`));

for (const {page, html} of pages) fs.writeFileSync(`${out}/${page}`, html);
console.log(`${pages.length} pages, ${links} links, ${sections.length} sections, ${entries.length} terms`);
process.exit(faults ? 1 : 0);
