// What may stand at a place of a scene, by the scene's own JSON schema.

/** Keys and columns of the mappings that the place is in, from the outermost on. */
function pathAt(text, at) {
  const lines = text.slice(0, at).split("\n");
  const current = lines.pop();
  const path = [];
  // Flow mappings on this line: an opening brace belongs to the key before it.
  const flow = [];
  let word = "";
  let key = "";
  let quoted = "";
  for (const c of current) {
    if (quoted) {
      if (c === quoted) quoted = "";
    } else if (c === '"' || c === "'") quoted = c;
    else if (c === "#") break;
    else if (c === "{" || c === "[") {
      flow.push({ key, open: c });
      word = key = "";
    } else if (c === "}" || c === "]") {
      flow.pop();
      word = key = "";
    } else if (c === ":") {
      key = word.trim();
      word = "";
    } else if (c === ",") word = key = "";
    else word += c;
  }
  const own = current.match(/^(\s*(?:- +)*)/)[1];
  let indent = own.length;
  const above = [];
  if (own.includes("-")) {
    above.unshift(...Array((own.match(/-/g) ?? []).length).fill(null));
    indent = own.indexOf("-");
  }
  for (const line of lines.reverse()) {
    if (!line.trim() || line.trim().startsWith("#")) continue;
    const lead = line.match(/^(\s*(?:- +)*)/)[1];
    const column = lead.length;
    const dashes = (lead.match(/-/g) ?? []).length;
    const mapping = line.slice(column).match(/^([\w-]+):\s*(?:#.*)?$/);
    const start = dashes ? lead.indexOf("-") : column;
    if (column < indent && mapping) {
      above.unshift(mapping[1]);
      indent = column;
      if (dashes) {
        above.unshift(...Array(dashes).fill(null));
        indent = start;
      }
    } else if (column === indent && mapping && own.includes("-") && !dashes && above[0] === null) {
      // A list that is as far in as its key.
      above.unshift(mapping[1]);
    } else if (dashes && column <= indent && start < indent) {
      above.unshift(...Array(dashes).fill(null));
      indent = start;
    }
    if (indent === 0 && !own.includes("-")) break;
  }
  path.push(...above);
  for (const { key: name, open } of flow) {
    if (name) path.push(name);
    if (open === "[") path.push(null);
  }
  return { path, word: word.trimStart(), key };
}

/** The schemas that a schema stands for: references and alternatives resolved. */
function alternatives(schema, root, depth = 0) {
  if (!schema || depth > 12) return [];
  if (schema.$ref) {
    const target = schema.$ref.replace("#/", "").split("/").reduce((at, part) => at?.[part], root);
    return alternatives(target, root, depth + 1);
  }
  const nested = [...(schema.oneOf ?? []), ...(schema.anyOf ?? []), ...(schema.allOf ?? [])];
  return [schema, ...nested.flatMap((one) => alternatives(one, root, depth + 1))];
}

/** The schemas at a path: a name for a key, null for an item of a list. */
function schemasAt(path, root) {
  let at = alternatives(root, root);
  for (const step of path) {
    at = at.flatMap((schema) => {
      if (step === null) {
        const items = [schema.items].flat().filter((item) => item && item !== true);
        return items.flatMap((item) => alternatives(item, root));
      }
      const found = schema.properties?.[step] ?? schema.additionalProperties;
      return found && found !== true ? alternatives(found, root) : [];
    });
  }
  return at;
}

const words = (schema) => [...(schema.enum ?? []), ...("const" in schema ? [schema.const] : [])];

/** The labels, kinds and texts of what may stand at that place of the text. */
export function suggestions(text, at, schema) {
  const { path, word, key } = pathAt(text, at);
  if (key) {
    const values = schemasAt([...path, key], schema);
    const known = new Map();
    for (const one of values) {
      for (const value of words(one)) known.set(String(value), { label: String(value), type: "constant", info: one.description });
      if (one.type === "boolean") for (const value of ["true", "false"]) known.set(value, { label: value, type: "constant" });
    }
    return { word, options: [...known.values()] };
  }
  const known = new Map();
  for (const one of schemasAt(path, schema)) {
    for (const [name, property] of Object.entries(one.properties ?? {})) {
      if (!known.has(name)) {
        const info = alternatives(property, schema).map((s) => s.description).find(Boolean);
        known.set(name, { label: name, apply: `${name}: `, type: "property", info });
      }
    }
    for (const value of words(one)) known.set(String(value), { label: String(value), type: "constant" });
  }
  return { word, options: [...known.values()] };
}
