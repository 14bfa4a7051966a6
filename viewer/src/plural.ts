// Numbers in sentences.

/** A count and what is counted: 1 triangle, 2,000 triangles. */
export function counted(count: number, one: string, many: string): string {
  return `${count.toLocaleString('en')} ${count === 1 ? one : many}`;
}
