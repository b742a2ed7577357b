"""Checks that the pages of a folder refer to nothing that is not there: pages, places in them, figures;
and that they show every figure of another folder: one that they do not was lost with the text about it.

usage: check_links.py FOLDER FIGURES
"""

import html.parser
import os
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.places, self.links = set(), set()

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.places.add(value)
            elif name in ("href", "src", "data") and value:
                self.links.add(value)


def main(folder, figures):
    pages = {}
    for name in sorted(os.listdir(folder)):
        if name.endswith(".html"):
            pages[name] = Page()
            with open(os.path.join(folder, name), encoding="utf-8") as text:
                pages[name].feed(text.read())
    broken = 0
    for name, page in pages.items():
        for link in sorted(page.links):
            url = urllib.parse.urlsplit(link)
            if url.scheme or url.netloc or link.startswith("javascript:"):
                continue
            target, place = urllib.parse.unquote(url.path) or name, urllib.parse.unquote(url.fragment)
            if not os.path.exists(os.path.join(folder, target)):
                print(f"{name}: there is no {target}")
                broken += 1
            elif place and target in pages and place not in pages[target].places:
                print(f"{name}: {target} has no place {place}")
                broken += 1
    shown = {os.path.basename(urllib.parse.urlsplit(l).path) for p in pages.values() for l in p.links}
    for figure in sorted(set(os.listdir(figures)) - shown):
        print(f"no page shows {figure}")
        broken += 1
    return 1 if broken or not pages else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
