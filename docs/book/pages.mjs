// Preprocessor of mdBook: the pages as a code-hosting site shows them. Formulas become HTML by KaTeX, links lead to
// where a page stands in the book, and names of crates to their reference. Code stays as it is.
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path/posix";
import { fileURLToPath } from "node:url";

if (process.argv[2] === "supports") process.exit();
const root = fileURLToPath(new URL("../..", import.meta.url));
const katex = createRequire(root + "target/tools/")("katex");
const [context, book] = JSON.parse(readFileSync(0, "utf8"));
const repository = context.config.output.html["git-repository-url"];
const errors = [];

// All chapters below some items.
const chaptersOf = (items) =>
    items.flatMap(({ Chapter: chapter }) => (chapter ? [chapter, ...chaptersOf(chapter.sub_items)] : []));

// Pages of the repository and where they stand in the book, which begins at docs/.
const chapters = chaptersOf(book.items);
const places = new Map();
for (const chapter of chapters) {
    const place = chapter.path.replace(/^(\.\.\/)+/, "").replace(/README\.md$/, "index.md");
    places.set(path.join("docs", chapter.path), place);
}
for (const file of readdirSync(root + "docs", { recursive: true })) {
    const stands = file === "SUMMARY.md" || places.has(path.join("docs", file));
    if (file.endsWith(".md") && !stands) errors.push(`docs/${file} is not in docs/SUMMARY.md`);
}

// A formula as HTML, of which Markdown sees no sign that it would take for its own.
function formula(page, tex, displayMode) {
    try {
        const html = katex.renderToString(tex, { displayMode, strict: "error" });
        return html.replace(/[\\`*_[\]|~$\n]/g, (sign) => `&#${sign.charCodeAt()};`);
    } catch (error) {
        errors.push(`${page}: ${error.message}\n    ${tex}`);
        return "";
    }
}

// A link, or its text alone where it leads out of the book and the repository has no address yet.
function link(page, text, target) {
    if (/^([a-z]+:|#)/.test(target)) return `${text}(${target})`;
    const [, file, anchor] = target.match(/^([^#]*)(.*)$/);
    const aim = path.join(path.dirname(page), file);
    if (!existsSync(root + aim)) errors.push(`${page}: ${target} is no file`);
    const place = places.get(aim) ?? aim.match(/^docs\/(.*)/)?.[1];
    if (place) return `${text}(${path.relative(path.dirname(places.get(page)), place)}${anchor})`;
    return repository ? `${text}(${repository}/blob/HEAD/${aim})` : text.slice(1, -1);
}

// A span of code; the first that names a crate or a module of Python on a page leads to its reference.
function code(page, span, linked) {
    const crate = span.match(/^`(tem00-[a-z]+)`$/)?.[1].replace("-", "_");
    const module = span.match(/^`tem00\.([a-z]+)`$/)?.[1];
    const file = crate ? `${crate}/index.html` : `python/tem00/${module}.html`;
    if (!(crate || module) || linked.has(file) || !existsSync(`${root}target/doc/${file}`)) return span;
    linked.add(file);
    const api = path.relative(path.dirname(places.get(page)), `api/${file}`);
    return `[${span}](${api})`;
}

// Blocks of code, spans of code, links, formulas in a line, and signs of formulas that are left.
const parts =
    /^( *)(```+)(.*)\n([^]*?)^ *\2 *$|(`+)[^]*?[^`]\5(?!`)|(!?\[(?:!\[[^\]]*\]\([^)\s]+\)|[^\]])*\])\(([^)\s]+)\)|\$((?:[^$\n]|\n(?!\n))+)\$|\$/gm;

// A picture, as the text of a link.
const picture = /(!\[[^\]]*\])\(([^)\s]+)\)/g;

for (const chapter of chapters) {
    const page = path.join("docs", chapter.path);
    const linked = new Set();
    chapter.path = places.get(page);
    chapter.content = chapter.content.replace(parts, (all, indent, fence, kind, block, tick, text, target, tex) => {
        if (fence) return kind === "math" ? indent + formula(page, block, true) : all;
        if (tick) return code(page, all, linked);
        if (text) return link(page, text.replace(picture, (_, alt, file) => link(page, alt, file)), target);
        if (!tex) errors.push(`${page}: a $ without its other`);
        return tex ? formula(page, tex, false) : all;
    });
}
if (errors.length) {
    console.error(errors.join("\n"));
    process.exit(1);
}
console.log(JSON.stringify(book));
