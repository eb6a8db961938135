// Error against run time, while it falls.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Step } from "../gen/alvor/v1/solve_service_pb";
import { secondsOf } from "./time";

const FLOOR = 1e-5; // of a share, on the logarithmic axis
const HEIGHT = 150;

export class Chart {
  private readonly plot: uPlot;
  private steps: Step[] = [];
  private tolerance = 0;

  constructor(private readonly host: HTMLElement) {
    const style = getComputedStyle(document.documentElement);
    const colour = (name: string) => style.getPropertyValue(name).trim();
    const thin = { stroke: colour("--line"), width: 1 };
    const axis = { stroke: colour("--ink"), grid: thin, ticks: thin };
    // A line for each power of ten is enough.
    const powers = (_: uPlot, all: number[]) => all.map((x) => (Number.isInteger(Math.log10(x)) ? x : null)) as number[];
    const line = (label: string, name: string, dash?: number[]) => ({
      label,
      stroke: colour(name),
      width: 2,
      dash,
      points: { show: false },
    });
    this.plot = new uPlot(
      {
        width: 320,
        height: HEIGHT,
        legend: { live: false },
        scales: { x: { time: false }, y: { distr: 3, range: (_, __, high) => [FLOOR, Math.max(1, high)] } },
        axes: [
          { ...axis, size: 32, values: (_, all) => all.map((s) => `${s} s`) },
          {
            ...axis,
            size: 64,
            filter: powers,
            grid: { ...thin, filter: powers },
            ticks: { ...thin, filter: powers },
            values: (_, all) => all.map((x) => (x === null ? "" : `${Number((100 * x).toPrecision(2))} %`)),
          },
        ],
        series: [
          {},
          line("Estimated error", "--error"),
          line("Unshot light", "--unshot"),
          line("Shown within", "--shown"),
          line("Tolerance", "--tolerance", [6, 4]),
        ],
      },
      [[], [], [], [], []],
      host,
    );
    new ResizeObserver(() => this.fit()).observe(host);
  }

  begin(tolerance: number): void {
    this.tolerance = tolerance;
    this.steps = [];
    this.draw();
  }

  add(steps: Step[]): void {
    this.steps.push(...steps);
    this.draw();
  }

  get all(): readonly Step[] {
    return this.steps;
  }

  private draw(): void {
    const column = (value: (step: Step) => number) => this.steps.map((step) => Math.max(FLOOR, value(step)));
    this.plot.setData([
      this.steps.map((step) => secondsOf(step.elapsed)),
      column((step) => step.estimatedError),
      column((step) => step.unshotFraction),
      column((step) => step.displayedError),
      column(() => this.tolerance),
    ]);
  }

  private fit(): void {
    const width = this.host.clientWidth;
    if (width > 0) this.plot.setSize({ width, height: HEIGHT });
  }
}
