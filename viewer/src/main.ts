// The page: opens models, and shows them.

import { App } from './page/app';

new App().start();
