// One Lloyd step by d3-delaunay, least of nine; n uniform random dots in the unit square.
import {Delaunay} from "d3-delaunay";
const n = Number(process.argv[2]);
const points = Float64Array.from({length: 2 * n}, Math.random);
const times = [];
for (let run = 0; run < 9; ++run) {
  const start = performance.now();
  const voronoi = new Delaunay(points).voronoi([0, 0, 1, 1]);
  const moved = new Float64Array(2 * n);
  for (let i = 0; i < n; ++i) {
    const cell = voronoi.cellPolygon(i);
    if (cell === null) continue;
    let area = 0, x = 0, y = 0;
    for (let k = 0; k + 1 < cell.length; ++k) {
      const [x0, y0] = cell[k], [x1, y1] = cell[k + 1], cross = x0 * y1 - x1 * y0;
      area += cross;
      x += (x0 + x1) * cross;
      y += (y0 + y1) * cross;
    }
    moved[2 * i] = x / (3 * area);
    moved[2 * i + 1] = y / (3 * area);
  }
  times.push(performance.now() - start);
}
times.sort((a, b) => a - b);
console.log(times[0]);
