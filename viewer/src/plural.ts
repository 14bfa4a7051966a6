// Counts in sentences.

/** A count with the noun in the singular or the plural: 1 triangle, 2,000 triangles. */
export function counted(count: number, one: string, many: string): string {
  return `${count.toLocaleString('en')} ${count === 1 ? one : many}`;
}
