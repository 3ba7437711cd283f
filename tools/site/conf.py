"""Settings of Sphinx for the site of `./dev docs`. MJARM_SITE_LANGUAGE is en or zh-CN; build.py sets it."""

import os
import pathlib
import re

from sphinx.search.en import SearchEnglish

here = pathlib.Path(__file__).resolve().parent
chosen = os.environ["MJARM_SITE_LANGUAGE"]
other = {"en": "zh-CN", "zh-CN": "en"}[chosen]

project = "mjarm"
language = {"en": "en", "zh-CN": "zh_CN"}[chosen]
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
myst_heading_anchors = 6
suppress_warnings = ["myst.header"]  # a page may begin below, and step over, a level of headings
highlight_language = "none"

html_theme = "furo"
html_title = "mjarm"
html_static_path = [str(here / "site.css")]
html_css_files = ["site.css"]
templates_path = [str(here)]
html_sidebars = {"**": ["sidebar/brand.html", "sidebar/search.html", "language.html", "sidebar/scroll-start.html", "sidebar/navigation.html",
                        "sidebar/scroll-end.html"]}
html_show_sphinx = html_show_copyright = html_copy_source = False
html_show_search_summary = False  # it fetches pages, which no browser does from disk


class Search(SearchEnglish):
    """English words by their stems; Chinese by every two neighbouring characters, in the index and in what is looked for."""

    js_splitter_code = r"""
var splitQuery = (query) => query.split(/[^\p{L}\p{N}_]+/u).flatMap((word) =>
  word.split(/([\u4e00-\u9fff]+)/).flatMap((part) => !/[\u4e00-\u9fff]{2}/.test(part) ? [part] :
    Array.from(part).slice(1).map((character, i) => part[i] + character))).filter((word) => word);
"""

    def split(self, text):
        words = []
        for part in re.findall(r"[\u4e00-\u9fff]+|[^\W\u4e00-\u9fff]+", text):
            words += [part[i:i + 2] for i in range(len(part) - 1)] if "\u4e00" <= part[0] <= "\u9fff" and len(part) > 1 else [part]
        return words


class SearchInChinese(Search):
    lang = "zh"


def add_switch(app, page, template, context, tree):
    """The same page in the other language."""
    context["other_name"] = {"en": "English", "zh-CN": "中文"}[other]
    context["other_lang"] = other
    context["other_page"] = "../" * (page.count("/") + 1) + f"{other}/{page}.html"


def setup(app):
    app.add_search_language(Search)
    app.add_search_language(SearchInChinese)
    app.connect("html-page-context", add_switch)
