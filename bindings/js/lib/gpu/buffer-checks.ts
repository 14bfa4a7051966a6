// Checks of the caller's buffers. WebGPU reports no error for a read past the end of a buffer: the value is unspecified.

/** Errors: a stride or an offset that is not a multiple of 4, or rows past the end of the buffer. */
export function checkRows(name: string, buffer: GPUBuffer, stride: number, offset: number, count: number, bytes: number): void {
  if (stride % 4 || offset % 4) throw new RangeError(`the stride and the offset of the ${name} must be multiples of 4`);
  checkLength(name, buffer, count && (count - 1) * stride + offset + bytes);
}

/** Errors: a buffer that is too small. */
export function checkLength(name: string, buffer: GPUBuffer, needed: number): void {
  if (needed > buffer.size) throw new RangeError(`the ${name} need ${needed} bytes but their buffer has ${buffer.size}`);
}
