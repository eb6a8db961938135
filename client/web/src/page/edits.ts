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

const addedBy = (edits: Edit[]) => edits.flatMap(({ part }) => (part.case === "copy" ? [part.value.name] : []));

/** Returns the names of objects that edits have added. */
export const copiesThatHold = (steps: EditStep[]) => addedBy(editsThatHold(steps));

/** Returns the names of objects that edits have added, with those that were taken back. */
export const copiesEverMade = (steps: EditStep[]) => addedBy(steps.flatMap(({ edits }) => edits));

/** Returns whether two edits set the same fields of the same part. */
export function areAlike(a: Edit, b: Edit): boolean {
  const fields = ({ part }: Edit) => {
    const set = Object.entries(part.value ?? {}).filter(([name, value]) => value !== undefined && !name.startsWith("$"));
    return [part.case, ...set.map(([name, value]) => (name === "name" ? value : name))].join();
  };
  return fields(a) === fields(b);
}

/** Returns a name for a copy: "chair.003 copy", "chair.003 copy 2". */
export function freeName(of: string, taken: Set<string>): string {
  return firstFree(`${of.replace(/ copy( \d+)?$/, "")} copy`, taken);
}

/** Returns a name that is free: "plant", "plant 2". */
export function firstFree(stem: string, taken: Set<string>): string {
  for (let n = 1; ; ++n) {
    const name = n === 1 ? stem : `${stem} ${n}`;
    if (!taken.has(name)) return name;
  }
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
  if (part.case === "medium") return "the air";
  if (part.case === "copy") return `${part.value.name}, added`;
  const { name } = part.value;
  if (part.case === "object" && part.value.hidden !== undefined) return `${name}, ${part.value.hidden ? "taken away" : "brought back"}`;
  if (part.case === "object" && part.value.move) return `${name}, moved`;
  if (part.case === "object" && part.value.turn !== undefined) return `${name}, turned to ${Math.round(part.value.turn)}°`;
  if (part.case === "object" && part.value.scale !== undefined) return `${name}, ${percent(part.value.scale)} of its size`;
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
