// The theme, sliders over pairs of pictures, search over all sections of the site, the menu's state, wide blocks that keys can scroll, and answers that open when the page is printed.

'use strict';

{
  const base = document.documentElement.dataset.base;
  const field = document.querySelector('input[type=search]');
  const found = document.querySelector('.found');
  const MOST = 12;

  /** Loads the texts of all sections, once. */
  let loading;
  const load = () =>
    (loading ??= new Promise((resolve, reject) => {
      const script = document.createElement('script');
      script.src = `${base}search-index.js`;
      script.onload = () => resolve(globalThis.searchIndex.map(([path, page, id, title, text]) => ({ path, page, id, title, text, low: text.toLowerCase(), lowTitle: title.toLowerCase() })));
      script.onerror = () => reject(new Error('the index of the search cannot be loaded'));
      document.head.append(script);
    }));

  /** What people look for first, and reports, which answer hardly anybody's question. */
  const FIRST = ['docs/learn/symptoms', 'docs/check.', 'docs/viewer', 'docs/matching-your-baker', 'index.html'];
  const LAST = ['docs/notes/', 'docs/check-mistakes', 'conformance/', 'benches/', 'docs/api/', 'CHANGELOG', 'CONTRIBUTING', 'ATTRIBUTION'];

  /** How well a section fits the words; 0 unless it has all of them. */
  function score({ low, lowTitle, page, path }, words) {
    let sum = FIRST.some((name) => path.startsWith(name)) ? 15 : 0;
    for (const word of words) {
      const inTitle = lowTitle.includes(word) ? 20 : 0;
      const inPage = page.toLowerCase().includes(word) ? 5 : 0;
      const times = low.split(word).length - 1;
      if (!inTitle && !inPage && !times) return 0;
      sum += inTitle + inPage + Math.min(times, 5);
    }
    return sum;
  }

  /** The text around the first of the words. */
  function excerpt({ text, low }, words) {
    const at = Math.max(0, ...words.map((word) => low.indexOf(word)).filter((at) => at >= 0).slice(0, 1));
    return `${at > 40 ? '… ' : ''}${text.slice(Math.max(0, at - 40), at + 120)} …`;
  }

  /** A text as nodes, with the words in it marked. */
  function marked(text, words) {
    const parts = text.split(new RegExp(`(${words.map((word) => word.replace(/[.*+?^${}()|[\]\\]/g, '\\$&')).join('|')})`, 'i'));
    return parts.map((part, at) => (at % 2 ? Object.assign(document.createElement('mark'), { textContent: part }) : part));
  }

  async function search() {
    const words = field.value.toLowerCase().split(/\s+/).filter((word) => word.length > 1);
    const sections = words.length ? await load() : [];
    const best = sections
      .map((section) => ({ section, score: score(section, words), isLast: LAST.some((name) => section.path.startsWith(name)) }))
      .filter(({ score }) => score > 0)
      .sort((a, b) => Number(a.isLast) - Number(b.isLast) || b.score - a.score)
      .slice(0, MOST);
    found.replaceChildren(...best.map(({ section }) => item(section, words)));
    if (words.length && !best.length) found.append(Object.assign(document.createElement('li'), { textContent: 'Nothing found.' }));
    found.hidden = !words.length;
  }

  function item(section, words) {
    const link = Object.assign(document.createElement('a'), {
      href: `${base}${section.path}${section.id ? `#${section.id}` : ''}`,
    });
    link.append(...marked(section.title && section.title !== section.page ? `${section.page}: ${section.title}` : section.page, words));
    const around = document.createElement('small');
    around.append(...marked(excerpt(section, words), words));
    const entry = document.createElement('li');
    entry.append(link, around);
    return entry;
  }

  document.addEventListener('keydown', (event) => {
    if (event.key !== '/' || event.ctrlKey || event.metaKey || event.target.matches('input, textarea, select')) return;
    event.preventDefault();
    field.focus();
  });

  // The system's colours, or those that the button chose before.
  const button = document.getElementById('theme');
  const setTheme = (theme) => (document.documentElement.dataset.theme = theme);
  // Browsers can be set to keep nothing for a page.
  const stored = (work) => {
    try {
      return work(localStorage);
    } catch {
      return null;
    }
  };
  const kept = stored((storage) => storage.getItem('theme'));
  if (kept === 'light' || kept === 'dark') setTheme(kept);
  button.hidden = false;
  button.addEventListener('click', () => {
    const isDark = document.documentElement.dataset.theme ? document.documentElement.dataset.theme === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
    setTheme(isDark ? 'light' : 'dark');
    stored((storage) => storage.setItem('theme', isDark ? 'light' : 'dark'));
  });

  field.addEventListener('input', search);
  field.form.addEventListener('submit', (event) => event.preventDefault());

  // The menu lies beside the page where there is room for it.
  const menu = document.querySelector('.menu');
  const isWide = matchMedia('(min-width: 64rem)');
  const setMenu = () => (menu.open = isWide.matches);
  isWide.addEventListener('change', setMenu);

  // So do the contents of the page.
  const contents = document.querySelector('.contents');
  const isWidest = matchMedia('(min-width: 100rem)');
  const setContents = () => contents && (contents.open = isWidest.matches);
  isWidest.addEventListener('change', setContents);
  setContents();
  setMenu();

  // Code and tables that are wider than the page can be scrolled by keys.
  const wide = new ResizeObserver((blocks) => {
    for (const { target } of blocks) {
      if (target.scrollWidth > target.clientWidth) target.tabIndex = 0;
      else target.removeAttribute('tabindex');
    }
  });
  document.querySelectorAll('main pre, main table').forEach((block) => wide.observe(block));

  // Sliders over pairs of pictures, for pages that have any.
  if (document.querySelector('main td > img')) document.head.append(Object.assign(document.createElement('script'), { src: `${base}pairs.js` }));

  addEventListener('beforeprint', () => document.querySelectorAll('main details').forEach((details) => (details.open = true)));
}
