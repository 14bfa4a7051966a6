export { default } from './wasm/check.scalar.wasm';
