// What callers hand over. Reads past a buffer are none of WebGPU's errors: they give anything.

/** Errors: rows that are not whole words apart, or past their buffer. */
export function checkRows(what: string, buffer: GPUBuffer, stride: number, offset: number, count: number, bytes: number): void {
  if (stride % 4 || offset % 4) throw new RangeError(`the ${what} are not whole words apart; strides and offsets must be multiples of 4`);
  reach(what, buffer, count && (count - 1) * stride + offset + bytes);
}

/** Errors: a buffer that ends too early. */
export function reach(what: string, buffer: GPUBuffer, needed: number): void {
  if (needed > buffer.size) throw new RangeError(`the ${what} need ${needed} bytes but their buffer has ${buffer.size}`);
}
