// Search: every word of the query has to be in a section; words in a title weigh more. The index is
// a script of its own, loaded when somebody searches, so that the pages also work from a disk.
'use strict';
const box = document.getElementById('search'), found = document.getElementById('found');

function escaped(text) {
    return text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;');
}

function excerpt(text, words) {
    const at = Math.max(0, text.toLowerCase().indexOf(words[0]) - 50);
    let piece = escaped(text.slice(at, at + 150));
    for (const word of words) {
        const plain = escaped(word).replace(/[.*+?^${}()|[\]\\]/g, '\\$&');
        piece = piece.replace(new RegExp(plain, 'gi'), '<mark>$&</mark>');
    }
    return (at ? '… ' : '') + piece + ' …';
}

function show(query) {
    const words = query.toLowerCase().split(/\s+/).filter((word) => word.length > 1);
    if (!words.length) return void (found.innerHTML = '');
    const hits = [];
    for (const section of window.searchIndex) {
        const title = section.title.toLowerCase(), text = section.text.toLowerCase();
        let weight = 0;
        for (const word of words) {
            const count = text.split(word).length - 1, named = title.includes(word);
            if (!count && !named) { weight = 0; break; }
            weight += Math.min(count, 5) + (named ? 20 : 0);
        }
        if (weight) hits.push([weight, section]);
    }
    hits.sort((a, b) => b[0] - a[0]);
    found.innerHTML = hits.slice(0, 15).map(([, section]) =>
        `<a href="${section.url}">${escaped(section.title)}<small>${excerpt(section.text, words)}</small></a>`
    ).join('') || '<p>Nothing found.</p>';
}

box.addEventListener('input', () => {
    if (window.searchIndex) return show(box.value);
    if (document.getElementById('index')) return;
    const script = document.createElement('script');
    script.id = 'index';
    script.src = 'search_index.js';
    script.onload = () => show(box.value);
    document.head.append(script);
});
document.addEventListener('keydown', (event) => {
    if (event.key === '/' && document.activeElement !== box) { event.preventDefault(); box.focus(); }
    if (event.key === 'Escape') { box.value = ''; found.innerHTML = ''; }
});
