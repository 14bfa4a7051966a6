// The page: opens models, and shows them.

import { App } from './page/app';
import { showError } from './page/status';

try {
  new App().start();
} catch (error) {
  // three.js says on the console what it found missing.
  showError(new Error('This browser shows no 3D pictures: WebGL 2 is missing or turned off.', { cause: error }));
}
