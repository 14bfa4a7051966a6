export { default } from './wasm/bake.scalar.wasm';
