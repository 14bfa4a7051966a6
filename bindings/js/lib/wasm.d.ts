// The type of an imported .wasm file: build.mjs embeds it deflated.
declare module '*.wasm' {
  const bytes: Uint8Array<ArrayBuffer>;
  export default bytes;
}
