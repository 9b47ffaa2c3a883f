// The API page: its code can be copied.

import { copyable } from "../code/copy.ts";

for (const listing of document.querySelectorAll<HTMLElement>(".listing")) copyable(listing);
