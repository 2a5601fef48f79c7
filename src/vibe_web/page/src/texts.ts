// Elements of the page, and how times are written.

export const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

export const minutes = (time: number) => {
  const tenths = Math.round(10 * time);
  return `${Math.floor(tenths / 600)}:${((tenths % 600) / 10).toFixed(1).padStart(4, '0')}`;
};

export function made(tag: string, text: string, className = '', title = ''): HTMLElement {
  const child = document.createElement(tag);
  child.textContent = text;
  child.className = className;
  if (title) child.title = title;
  return child;
}

export function row(cells: string[], className: string, title: string): HTMLElement {
  const line = made('tr', '', className, title);
  line.append(...cells.map((cell) => made('td', cell)));
  return line;
}
