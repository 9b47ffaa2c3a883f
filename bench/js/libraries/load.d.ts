import type { Library, LibraryModule } from "./index.js";

export function load(library: Library): Promise<LibraryModule>;
