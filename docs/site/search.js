// Finds sections by lunr (BM25 with stemming) in what sections.py has written, and shows them by page with their text.
const SHOWN_SECTIONS = 3; // of a page
const SNIPPET = 240; // characters

lunr.tokenizer.separator = /[^\p{L}\p{N}_]+/u;
const sections = PAGES.flatMap(([page, title, weight, parts]) =>
  parts.map(([anchor, heading, text]) => ({ page, title, weight, anchor, heading, text })));
const index = lunr(function () {
  this.b(0.3); // long sections are tables, not diluted
  this.field("heading", { boost: 4 });
  this.field("title", { boost: 3 });
  this.field("text");
  this.ref("number");
  this.metadataWhitelist = ["position"];
  sections.forEach((section, number) => this.add({ number, ...section }, { boost: section.weight }));
});

/** Sections with the words, or words that begin so; where there are none, with words of one other letter. */
function hits(words) {
  const ask = (distance) => index.query((query) => {
    for (const token of lunr.tokenizer(words)) {
      query.term(token.toString(), { boost: 10, editDistance: distance });
      query.term(token.toString() + "*", { usePipeline: false });
    }
  });
  const exact = ask(0);
  return exact.length ? exact : ask(1);
}

/** Pages in the order of their best sections: [{page, title, sections: [{anchor, heading, text, places}]}]. */
function find(words) {
  const pages = new Map();
  for (const { ref, matchData } of hits(words)) {
    const section = sections[ref];
    if (!pages.has(section.page)) pages.set(section.page, { ...section, sections: [] });
    const places = Object.values(matchData.metadata).flatMap((fields) => fields.text?.position ?? []);
    pages.get(section.page).sections.push({ ...section, places: places.sort((a, b) => a[0] - b[0]) });
  }
  return [...pages.values()];
}

/** The text around the first place, with all places in it marked. */
function snippet({ text, places }) {
  const begin = Math.max(0, (places[0]?.[0] ?? 0) - SNIPPET / 4);
  const from = begin && text.indexOf(" ", begin) + 1;
  const rest = text.slice(from + SNIPPET);
  const end = from + SNIPPET + Math.max(0, rest.indexOf(" ")); // not within a word
  const shown = document.createElement("p");
  let at = from;
  for (const [start, length] of places) {
    if (start < at || start + length > end) continue;
    shown.append(text.slice(at, start));
    shown.appendChild(document.createElement("mark")).textContent = text.slice(start, start + length);
    at = start + length;
  }
  shown.append(text.slice(at, end) + (end < text.length ? " …" : ""));
  if (from) shown.prepend("… ");
  return shown;
}

function link(parent, kind, address, words) {
  const anchor = parent.appendChild(document.createElement(kind)).appendChild(document.createElement("a"));
  anchor.href = address;
  anchor.textContent = words;
}

function show(words) {
  const found = find(words);
  document.querySelectorAll("input[name=q]").forEach((input) => (input.value = words));
  document.getElementById("search-found").textContent = words.trim() === "" ? "Which word?" : found.length === 0
    ? `No page has '${words}'. Another word for it may help; all pages are in the column on the left.`
    : found.length === 1 ? `One page has '${words}'.` : `${found.length} pages for '${words}', the best first.`;
  const results = document.getElementById("search-results");
  for (const page of found) {
    link(results, "h2", page.page + ".html", page.title);
    for (const section of page.sections.slice(0, SHOWN_SECTIONS)) {
      if (section.anchor) link(results, "h3", page.page + ".html" + section.anchor, section.heading);
      results.append(snippet(section));
    }
  }
}

if (typeof document !== "undefined") show(new URLSearchParams(location.search).get("q") ?? "");
