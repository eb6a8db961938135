// Files and folders that a person drops on the page.

const MOST_FILES = 1000;

/** `onFiles` is given the files, those of folders too: their webkitRelativePath tells where they were. */
export function listenToDrops(stage: HTMLElement, onFiles: (files: Promise<File[]>) => void): void {
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    stage.classList.add("dropping");
  });
  document.addEventListener("dragleave", () => stage.classList.remove("dropping"));
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    stage.classList.remove("dropping");
    if (!event.dataTransfer?.files.length) return;
    // Entries must be asked for before the event is over.
    const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
    onFiles(entries.some((entry) => entry.isDirectory) ? filesOf(entries) : Promise.resolve([...event.dataTransfer.files]));
  });
}

async function filesOf(entries: FileSystemEntry[]): Promise<File[]> {
  const files: File[] = [];
  for (let next = entries.shift(); next && files.length < MOST_FILES; next = entries.shift())
    if (next.isDirectory) entries.push(...(await entriesOf(next as FileSystemDirectoryEntry)));
    else files.push(await fileOf(next as FileSystemFileEntry));
  return files;
}

async function fileOf(entry: FileSystemFileEntry): Promise<File> {
  const file = await new Promise<File>((resolve, reject) => entry.file(resolve, reject));
  return Object.defineProperty(file, "webkitRelativePath", { value: entry.fullPath.slice(1) });
}

/** A reader gives a hundred entries at a time, and none at the end. */
async function entriesOf(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return all;
    all.push(...some);
  }
}
