// The entry of the viewer's page.

import { App } from './page/app';
import { showError } from './page/status';

try {
  new App().start();
} catch (error) {
  // three.js has logged the details on the console.
  showError(new Error('This browser cannot show 3D: WebGL 2 is missing or disabled.', { cause: error }));
}
