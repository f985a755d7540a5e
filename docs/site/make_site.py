#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes a site of the pages for readers: copies those of mkdocs.yml and the files that they link to, as they lie in the
tree, so that their links hold, and runs MkDocs, for which every broken link is an error.

usage: make_site.py SOURCE (into SOURCE/build/site)
"""
import os
import re
import shutil
import subprocess
import sys


def pages_of(config):
    with open(config, encoding='utf-8') as file:
        return re.findall(r'^\s+- [^:]+: (\S+\.md)$', file.read(), re.MULTILINE)


def linked_files(source, page):
    """What a page links to in the tree, and is no page itself; folders as the file that explains them."""
    with open(os.path.join(source, page), encoding='utf-8') as file:
        targets = re.findall(r'\]\(([^)#:\s]+)', file.read())
    found = [os.path.normpath(os.path.join(os.path.dirname(page), target)) for target in targets]
    return [path for path in found if os.path.isfile(os.path.join(source, path))]


def main():
    source = os.path.abspath(sys.argv[1])
    config, pages = os.path.join(source, 'docs/site/mkdocs.yml'), os.path.join(source, 'build/site-pages')
    shutil.rmtree(pages, ignore_errors=True)
    wanted = pages_of(config)
    for path in sorted({*wanted, *(path for page in wanted for path in linked_files(source, page))}):
        os.makedirs(os.path.dirname(os.path.join(pages, path)), exist_ok=True)
        shutil.copyfile(os.path.join(source, path), os.path.join(pages, path))
    # Pages name folders of the tree, which the site has not.
    for page in wanted:
        with open(os.path.join(pages, page), encoding='utf-8') as file:
            text = file.read()
        def plain(link):
            target = os.path.normpath(os.path.join(os.path.dirname(page), link[2]))
            return link[1] if os.path.isdir(os.path.join(source, target)) else link[0]
        text = re.sub(r'\[([^\]]*)\]\(([^)#:\s]+)\)', plain, text)
        with open(os.path.join(pages, page), 'w', encoding='utf-8') as file:
            file.write(text)
    environment = {**os.environ, 'NO_MKDOCS_2_WARNING': '1'}  # of what becomes of its theme
    sys.exit(subprocess.run([sys.executable, '-m', 'mkdocs', 'build', '--strict', '--quiet', '-f', config], env=environment).returncode)


if __name__ == '__main__':
    main()
