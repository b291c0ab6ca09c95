"""Each link inside the book leads to a file, and each anchor to a place.

Addresses elsewhere are not asked.
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """What a page links to, and what others may link to in it."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.names = {""}
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.links += [value for key, value in attrs if key in ("href", "src") and value]
        self.names |= {value for key, value in attrs if key in ("id", "name") and value}


book = Path(sys.argv[1]).resolve()
# Of the reference the front page of each crate; rustdoc has checked its links.
files = [
    file
    for file in book.rglob("*.html")
    if file.match("api/*/index.html") or book / "api" not in file.parents
]
pages = {file: Page(file) for file in files}
dead = []
for file, page in pages.items():
    for link in page.links:
        address = urlsplit(link)
        target = (file.parent / unquote(address.path)).resolve() if address.path else file
        if address.scheme or address.netloc:
            continue
        if (
            not target.is_file()
            or target in pages
            and unquote(address.fragment) not in pages[target].names
        ):
            dead.append(f"{file.relative_to(book)}: {link}")
if dead:
    sys.exit("dead links:\n" + "\n".join(dead))
print(len(pages), "pages,", sum(len(page.links) for page in pages.values()), "links")
