export { default } from './wasm/darboux.scalar.wasm';
