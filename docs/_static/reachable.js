/* What scrolls can be reached by the keyboard, and headings of the contents have a level. */
function makeReachable() {
  for (const heading of document.querySelectorAll("p.caption[role=heading]")) heading.setAttribute("aria-level", "2");
  for (const box of document.querySelectorAll("pre, .table-wrapper, div.math, .toc-scroll, .sidebar-scroll"))
    if (box.scrollWidth > box.clientWidth || box.scrollHeight > box.clientHeight) box.tabIndex = 0;
    else box.removeAttribute("tabindex");
}
addEventListener("load", makeReachable);
addEventListener("resize", makeReachable);
