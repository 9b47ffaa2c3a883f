import type { Contender, ContenderModule } from "./index.js";

export function load(contender: Contender): Promise<ContenderModule>;
