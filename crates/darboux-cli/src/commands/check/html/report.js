for (const frame of document.querySelectorAll('.frame')) {
  const slider = frame.querySelector('input');
  const move = () => frame.style.setProperty('--split', `${slider.value}%`);
  slider.hidden = false;
  slider.addEventListener('input', move);
  frame.classList.add('is-live');
  move();
}
