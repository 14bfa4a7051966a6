export { default } from './wasm/tangents.scalar.wasm';
