// Sorts the table by the column whose head is clicked; a second click reverses the order.
for (const table of document.querySelectorAll("table.sortable")) {
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    head.onclick = () => {
      const down = head.dataset.order === "up";
      heads.forEach((other) => delete other.dataset.order);
      head.dataset.order = down ? "down" : "up";
      const value = (row) => row.cells[column].dataset.value ?? row.cells[column].textContent;
      const compare = (a, b) => {
        const [x, y] = [value(a), value(b)];
        // Cells without a number come last in either order.
        if (x === "" || y === "") return (x === "") - (y === "");
        const numbers = Number(x) - Number(y);
        const order = Number.isNaN(numbers) ? x.localeCompare(y) : numbers;
        return down ? -order : order;
      };
      const body = table.tBodies[0];
      body.append(...[...body.rows].sort(compare));
    };
  });
}
// Shows the files of one verdict, or all.
for (const button of document.querySelectorAll("button[data-verdict]")) {
  button.onclick = () => {
    const wanted = button.dataset.verdict;
    for (const row of document.querySelectorAll("table.files tbody tr")) {
      row.hidden = wanted !== "" && row.dataset.verdict !== wanted;
    }
  };
}
