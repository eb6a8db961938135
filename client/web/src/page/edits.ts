// The edits of a solve: which of them hold, and sentences about them.

import { EditStep_Kind, type Edit, type EditStep } from "../gen/alvor/v1/solve_service_pb";

/** Plays steps through: those that hold after all undos and redos, and those that were taken back and can be repeated. */
function replay(steps: EditStep[]): { hold: EditStep[]; undone: EditStep[] } {
  const hold: EditStep[] = [];
  let undone: EditStep[] = [];
  for (const step of steps) {
    if (step.kind === EditStep_Kind.UNDO) undone.push(hold.pop()!);
    else if (step.kind === EditStep_Kind.REDO) hold.push(undone.pop()!);
    else {
      hold.push(step);
      undone = [];
    }
  }
  return { hold, undone };
}

/** Returns the edits that hold after all undos and redos, oldest first. */
export function editsThatHold(steps: EditStep[]): Edit[] {
  return replay(steps).hold.flatMap(({ edits }) => edits);
}

/** Returns whether there is a step to take back, and one to repeat. */
export function undoAndRedo(steps: EditStep[]): { undo: boolean; redo: boolean } {
  const { hold, undone } = replay(steps);
  return { undo: hold.length > 0, redo: undone.length > 0 };
}

const percent = (share: number) => `${Math.round(100 * share)} %`;

function textOfEdit({ part }: Edit): string {
  if (part.case === undefined) return "something";
  if (part.case === "daylight") return "sun and sky";
  const { name } = part.value;
  if (part.case === "object" && part.value.hidden !== undefined) return `${name}, ${part.value.hidden ? "taken away" : "brought back"}`;
  if (part.case === "object" && part.value.move) return `${name}, moved`;
  if (part.case === "object" && part.value.turn !== undefined) return `${name}, turned to ${Math.round(part.value.turn)}°`;
  const dim = part.case !== "material" ? part.value.dim : undefined;
  return dim === undefined ? name : `${name} at ${percent(dim)}`;
}

/** Returns a sentence about who did what in a step. */
export function textOfStep(step: EditStep): string {
  const who = step.author || "Somebody";
  if (step.kind === EditStep_Kind.UNDO) return `${who} took the last edit back`;
  if (step.kind === EditStep_Kind.REDO) return `${who} made the last edit again`;
  return `${who} edited ${step.edits.map(textOfEdit).join(", ")}`;
}
