// page_numbers.js PDF PRINT: puts the pages on which chapters begin in PDF into the contents of PRINT,
// for the second printing. Chromium has no target-counter(), and writes where each anchor is as
// "/NAME [OBJECT 0 R /XYZ ...]"; the objects of pages stand in the order of the pages.
'use strict';
const fs = require('fs');
const [pdf, print] = process.argv.slice(2);
const text = fs.readFileSync(pdf, 'latin1');
const pages = [...text.matchAll(/^(\d+) 0 obj\s*<<\/Type \/Page\b(?!s)/gm)].map((match) => match[1]);
const page_of = new Map([...text.matchAll(/\/([^\s\/\[\]]+) \[(\d+) 0 R \/XYZ/g)].map(([, name, page]) => [name, pages.indexOf(page) + 1]));
const html = fs.readFileSync(print, 'utf8').replace(/<a href="#([^"]*)"(>[\s\S]*?<\/a>)<i><\/i>/g, (all, name, rest) => {
    if (!page_of.get(name)) throw new Error(`${pdf} does not say on which page ${name} is`);
    return `<a href="#${name}"${rest}<i>${page_of.get(name)}</i>`;
});
fs.writeFileSync(print, html);
