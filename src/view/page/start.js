// Starts the page, once all scripts are there.
'use strict';

listen();
tick();
