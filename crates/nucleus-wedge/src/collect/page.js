// A click on a heading sorts by its column; a second click reverses the order.
const body = document.querySelector('tbody');
document.querySelectorAll('th').forEach((head, column) => head.addEventListener('click', () => {
  const sign = head.dataset.sign === '1' ? -1 : 1;
  head.dataset.sign = sign;
  const text = row => row.cells[column].textContent;
  const order = (a, b) => {
    const [x, y] = [text(a), text(b)];
    return x === '' || y === '' ? (x === '') - (y === '') : sign * (Number(x) - Number(y) || x.localeCompare(y));
  };
  body.append(...[...body.rows].sort(order));
}));
