// Two pictures beside each other in a table, a right and a wrong one, become one picture under a slider. Without this script they stay a table.

'use strict';

for (const table of document.querySelectorAll('main table')) {
  const heads = [...table.querySelectorAll('th')].map((head) => head.textContent.trim());
  const pictures = [...table.querySelectorAll('td')].map((cell) => cell.querySelector(':only-child:is(img)'));
  if (heads.length === 2 && pictures.length === 2 && pictures.every(Boolean)) table.replaceWith(slider(heads, pictures));
}

function slider(heads, pictures) {
  const [figure, box] = ['figure', 'div'].map((name) => document.createElement(name));
  box.className = 'pair';
  const input = Object.assign(document.createElement('input'), { type: 'range', min: '0', max: '100', value: '50', ariaLabel: `Percent of the picture that shows: ${heads[0]}; the rest: ${heads[1]}` });
  const move = () => box.style.setProperty('--split', `${input.value}%`);
  input.addEventListener('input', move);
  box.append(...pictures, input);
  move();
  const caption = Object.assign(document.createElement('figcaption'), { textContent: `${heads[0]} ↔ ${heads[1]}` });
  figure.append(box, caption);
  return figure;
}
