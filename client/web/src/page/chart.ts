// Error against run time, while it falls.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Step } from "../gen/alvor/v1/solve_service_pb";
import { secondsOf } from "./time";

const FLOOR = 1e-6; // of a share, on the logarithmic axis

export class Chart {
  private readonly plot: uPlot;
  private steps: Step[] = [];
  private tolerance = 0;

  constructor(private readonly host: HTMLElement) {
    const style = getComputedStyle(document.documentElement);
    const colour = (name: string) => style.getPropertyValue(name).trim();
    const axis = { stroke: colour("--ink"), grid: { stroke: colour("--line") }, ticks: { stroke: colour("--line") } };
    const line = (label: string, name: string, dash?: number[]) => ({
      label,
      stroke: colour(name),
      width: 2,
      dash,
      points: { show: false },
      value: (_: uPlot, x: number | null) => (x === null ? "" : `${(100 * x).toPrecision(3)} %`),
    });
    this.plot = new uPlot(
      {
        width: 320,
        height: 200,
        scales: { x: { time: false }, y: { distr: 3 } },
        axes: [
          { ...axis, values: (_, all) => all.map((s) => `${s} s`) },
          { ...axis, size: 60, values: (_, all) => all.map((x) => (x === null ? "" : `${Number((100 * x).toPrecision(2))} %`)) },
        ],
        series: [
          { label: "Run time", value: (_, s) => (s === null ? "" : `${s.toPrecision(3)} s`) },
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
    if (width > 0) this.plot.setSize({ width, height: 200 });
  }
}
