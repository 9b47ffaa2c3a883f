// Which file of a Rust crate imports which other file. See tests/imports.test.mjs for the rule.
import { readFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";

const ITEM_KEYWORDS = new Set(["fn", "struct", "enum", "union", "trait", "type", "const", "static", "macro_rules"]);

/** The tokens of Rust source that matter here: words, `::` and single punctuation. Comments and strings go. */
function tokenize(source) {
  const skipped =
    /\/\/[^\n]*|\/\*[\s\S]*?\*\/|(?:b|c)?r(#*)"[\s\S]*?"\1|(?:b|c)?"(?:[^"\\]|\\[\s\S])*"|b?'(?:[^'\\\n]|\\[^\n]+?)'|'(?:static|[a-z_]\w*)/y;
  const taken = /\$?[A-Za-z_]\w*|::|[^\s\w]/y;
  const tokens = [];
  for (let at = 0; at < source.length; ) {
    skipped.lastIndex = taken.lastIndex = at;
    if (skipped.test(source)) {
      at = skipped.lastIndex;
      continue;
    }
    const token = taken.exec(source)?.[0];
    if (token) tokens.push(token === "$crate" ? "crate" : token);
    at += token?.length ?? 1;
  }
  return tokens;
}

/** The index after the bracket that closes the one at `open`. */
function afterClosing(tokens, open) {
  for (let at = open, depth = 0; at < tokens.length; at++) {
    if ("([{".includes(tokens[at])) depth++;
    else if (")]}".includes(tokens[at]) && --depth === 0) return at + 1;
  }
  return tokens.length;
}

/** The index after the item that begins at `at`: after its `;` or its body. */
function afterItem(tokens, at) {
  while (at < tokens.length) {
    if (tokens[at] === ";") return at + 1;
    if (tokens[at] === "{") return afterClosing(tokens, at);
    at = "([".includes(tokens[at]) ? afterClosing(tokens, at) : at + 1;
  }
  return at;
}

const isTestOnly = (attribute) =>
  attribute.includes("cfg") && attribute.includes("test") && !attribute.includes("not");

/** The name of the type that the `impl` at `at` is for, and where its body begins. */
function readImpl(tokens, at) {
  let name;
  let angles = 0;
  for (at++; tokens[at] !== "{" && tokens[at] !== ";" && at < tokens.length; at++) {
    if (tokens[at] === "<") angles++;
    else if (tokens[at] === ">" && tokens[at - 1] !== "-") angles--;
    else if (angles > 0) continue;
    else if (tokens[at] === "for") name = undefined;
    else if (tokens[at] === "where") break;
    else if (/^[A-Z]/.test(tokens[at]) && tokens[at - 1] !== "::") name ??= tokens[at];
    else if (/^[A-Z]/.test(tokens[at])) name = tokens[at];
  }
  while (tokens[at] !== "{" && at < tokens.length) at++;
  return { name, body: tokens.slice(at, afterClosing(tokens, at)) };
}

/** What the body of an `impl` defines, and what it calls on `self` and `Self`. */
function readMethods(body) {
  const defined = new Set();
  const called = new Set();
  for (let at = 0; at < body.length; at++) {
    if (body[at] === "fn") defined.add(body[at + 1]);
    const isCall = (body[at] === "self" && body[at + 1] === ".") || (body[at] === "Self" && body[at + 1] === "::");
    if (isCall && ["(", "::"].includes(body[at + 3])) called.add(body[at + 2]);
  }
  return { defined, called };
}

/** `use a::{b, c::{self as d, *}};` as a list of { path, name } with name "*" for globs. */
function parseUse(tokens, at) {
  const imports = [];
  const tree = (prefix) => {
    const path = [...prefix];
    for (;;) {
      if (tokens[at] === "{") {
        at++;
        while (tokens[at] !== "}") {
          tree(path);
          if (tokens[at] === ",") at++;
        }
        at++;
        return;
      }
      if (tokens[at] === "*") {
        at++;
        imports.push({ path, name: "*" });
        return;
      }
      if (tokens[at] === "::") {
        at++;
        continue;
      }
      path.push(tokens[at++]);
      if (tokens[at] !== "::") break;
    }
    if (path.length > 1 && path.at(-1) === "self") path.pop();
    let name = path.at(-1);
    if (tokens[at] === "as") {
      name = tokens[at + 1];
      at += 2;
    }
    imports.push({ path, name });
  };
  tree([]);
  return { imports, end: at };
}

/** Reads the module of a file, and all modules below it, into `modules`. */
function readModule(file, parent, folder, modules) {
  const source = readFileSync(file, "utf8");
  const tokens = tokenize(source);
  // Modules whose files an attribute names: by the name of the module.
  const named = source.matchAll(/^#\[path = "(.*)"\]\s*(?:pub )?mod (\w+);/gm);
  const pathOf = new Map([...named].map(([, path, name]) => [name, join(dirname(file), path)]));
  const create = (parent) => ({
    file,
    parent,
    items: new Set(),
    children: new Map(),
    imports: new Map(),
    globs: [],
    paths: [],
    words: new Set(),
    impls: [],
  });
  const top = create(parent);
  modules.push(top);
  // The inline modules that are open, innermost last, with the depth at which each one's items are.
  const open = [{ module: top, depth: 0 }];
  let depth = 0;
  let isPublic = false;
  for (let at = 0; at < tokens.length; ) {
    const token = tokens[at];
    const { module, depth: itemDepth } = open.at(-1);
    if (token === "#") {
      const start = tokens[at + 1] === "!" ? at + 2 : at + 1;
      const end = afterClosing(tokens, start);
      const testOnly = start === at + 1 && isTestOnly(tokens.slice(start, end));
      at = end;
      if (testOnly) {
        while (tokens[at] === "#") at = afterClosing(tokens, at + 1);
        at = afterItem(tokens, at);
      }
      continue;
    }
    if (token === "pub") {
      isPublic = true;
      at = tokens[at + 1] === "(" ? afterClosing(tokens, at + 1) : at + 1;
      if (tokens[at] === "use") continue;
      isPublic = false;
      continue;
    }
    if (token === "use") {
      const { imports, end } = parseUse(tokens, at + 1);
      for (const { path, name } of imports) {
        if (name === "*") module.globs.push({ path, isPublic });
        else module.imports.set(name, { path, isPublic });
      }
      isPublic = false;
      at = end;
      continue;
    }
    if (token === "mod" && tokens[at + 2] === ";") {
      const name = tokens[at + 1];
      const candidates = pathOf.has(name) ? [pathOf.get(name)] : [join(folder, `${name}.rs`), join(folder, name, "mod.rs")];
      const path = candidates.find((it) => exists(it));
      if (!path) throw new Error(`${file} declares mod ${name}, but neither ${candidates.join(" nor ")} exists.`);
      module.children.set(name, readModule(path, module, join(folder, name), modules));
      at += 3;
      continue;
    }
    if (token === "mod" && tokens[at + 2] === "{") {
      const inline = create(module);
      // A module that a macro makes may stand anywhere below: what it does not have itself is looked up around it.
      inline.isFromMacro = tokens[at + 1].startsWith("$");
      modules.push(inline);
      module.children.set(tokens[at + 1], inline);
      depth++;
      open.push({ module: inline, depth });
      at += 3;
      continue;
    }
    if (token === "impl" && depth === itemDepth) {
      const { name, body } = readImpl(tokens, at);
      if (name) module.impls.push({ name, ...readMethods(body) });
    }
    if (token === "{") depth++;
    if (token === "}") {
      depth--;
      if (open.length > 1 && depth < itemDepth) open.pop();
    }
    if (ITEM_KEYWORDS.has(token) && depth === itemDepth) {
      const name = tokens[at + 1] === "!" ? tokens[at + 2] : tokens[at + 1];
      if (/^\w+$/.test(name ?? "") && !ITEM_KEYWORDS.has(name)) module.items.add(name);
    }
    if (/^[A-Za-z_]/.test(token) && tokens[at - 1] !== "." && tokens[at - 1] !== "::") {
      const path = [token];
      let end = at + 1;
      while (tokens[end] === "::" && /^[A-Za-z_]/.test(tokens[end + 1] ?? "")) {
        path.push(tokens[end + 1]);
        end += 2;
      }
      if (path.length > 1) module.paths.push(path);
      module.words.add(token);
      at = end;
      continue;
    }
    at++;
  }
  return top;
}

function exists(path) {
  try {
    readFileSync(path);
    return true;
  } catch {
    return false;
  }
}

/** Whose module or file a path leads to: { module }, { file }, or nothing for other crates. */
function resolve(path, from, root, seen = new Set()) {
  let module = from;
  let at = 0;
  if (path[0] === "crate") {
    module = root;
    at = 1;
  } else if (path[0] === "self" || path[0] === "super") {
    for (; path[at] === "self" || path[at] === "super"; at++) {
      if (path[at] === "super") module = module.parent ?? module;
    }
  } else if (!module.children.has(path[0]) && !module.imports.has(path[0]) && !module.items.has(path[0])) {
    return fromGlobs(path, module, root, seen);
  }
  for (; at < path.length; at++) {
    const name = path[at];
    const isLast = at === path.length - 1;
    const imported = module.imports.get(name);
    const key = `${module.file}\0${name}\0${isLast}`;
    if (imported && !(module.children.has(name) && !isLast) && !seen.has(key)) {
      const found = resolve(imported.path, module, root, new Set([...seen, key]));
      if (!found?.module || isLast) return found;
      module = found.module;
    } else if (module.children.has(name)) {
      module = module.children.get(name);
    } else if (module.items.has(name)) {
      return { file: module.file };
    } else {
      // What a macro defines is not visible here: it is taken to be in the module's own file.
      return fromGlobs(path.slice(at), module, root, seen) ?? { file: module.file };
    }
  }
  return { module };
}

function fromGlobs(path, module, root, seen) {
  for (const glob of module.globs) {
    const key = `${module.file}\0${glob.path.join("::")}\0*${path[0]}`;
    if (seen.has(key)) continue;
    const target = resolve(glob.path, module, root, new Set([...seen, key]))?.module;
    if (!target || target === module) continue;
    if (target.items.has(path[0]) || target.imports.has(path[0]) || target.children.has(path[0])) {
      return resolve(["self", ...path], target, root, new Set([...seen, key]));
    }
  }
  return module.isFromMacro ? resolve(path, module.parent, root, seen) : undefined;
}

/** Map of file -> Map of imported file -> names, for the crate whose root file is `rootFile`. */
export function rustImports(rootFile) {
  const modules = [];
  const root = readModule(rootFile, undefined, dirname(rootFile), modules);
  const graph = new Map(modules.map((module) => [module.file, new Map()]));
  const addEdge = (from, to, name) => {
    if (!to || from === to) return;
    const imports = graph.get(from);
    if (!imports.has(to)) imports.set(to, new Set());
    imports.get(to).add(name);
  };
  // "file of the type\0type\0method" -> the file whose `impl` has the method.
  const methods = new Map();
  const typeKey = (module, name) => `${resolve([name], module, root)?.file}\0${name}`;
  for (const module of modules) {
    for (const { name, defined } of module.impls) {
      for (const method of defined) methods.set(`${typeKey(module, name)}\0${method}`, module.file);
    }
  }
  for (const module of modules) {
    const add = (path) => addEdge(module.file, resolve(path, module, root)?.file, path.at(-1));
    for (const { name, called } of module.impls) {
      for (const method of called) addEdge(module.file, methods.get(`${typeKey(module, name)}\0${method}`), `self.${method}()`);
    }
    for (const [name, { path, isPublic }] of module.imports) {
      if (!isPublic || module.words.has(name)) add(path);
    }
    for (const { path, isPublic } of module.globs) {
      const target = resolve(path, module, root)?.module;
      if (!target || isPublic) continue;
      const offered = [...target.items, ...target.imports.keys()];
      for (const name of offered.filter((it) => module.words.has(it))) add([...path, name]);
    }
    for (const path of module.paths) add(path);
  }
  return graph;
}

/** The file at the root of a crate's folder of sources. */
export function crateRoot(folder) {
  const root = ["lib.rs", "main.rs"].map((name) => join(folder, name)).find(exists);
  if (!root) throw new Error(`${basename(folder)} has neither lib.rs nor main.rs`);
  return root;
}
