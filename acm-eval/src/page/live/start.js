/* Everything begins. Numbers of a figure are read once it comes near the window, when nothing else is to be done. */

const soon = window.requestIdleCallback || (work => setTimeout(work, 1));

figures = all("script.plotted").map(data => new Figure(data));
spaces = all("script.space").map(data => new Space(data));
const near = new IntersectionObserver(seen => {
  for (const { target, isIntersecting } of seen) {
    const figure = figures.find(one => one.card === target);
    if (isIntersecting && !figure.loaded) soon(() => figure.load());
    if (isIntersecting) near.unobserve(target);
  }
}, { rootMargin: "50% 0px" });
figures.forEach(figure => near.observe(figure.card));
all(".scroll table").forEach(makeSortable);
tableDownloads();
document.documentElement.classList.add("answers");
performance.mark("answers");
