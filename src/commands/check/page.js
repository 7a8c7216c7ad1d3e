for (const head of document.querySelectorAll("th[data-sort]")) {
  head.addEventListener("click", () => {
    const column = [...head.parentNode.children].indexOf(head);
    const body = head.closest("table").tBodies[0];
    const down = head.dataset.down !== "yes";
    head.dataset.down = down ? "yes" : "no";
    const key = (row) => row.children[column].dataset.key ?? row.children[column].textContent;
    const numbers = head.dataset.sort === "number";
    const rows = [...body.rows].sort((a, b) =>
      numbers ? Number(key(b)) - Number(key(a)) : key(a).localeCompare(key(b), undefined, { numeric: true }));
    if (!down) rows.reverse();
    body.append(...rows);
  });
}
