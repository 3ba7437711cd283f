// Tests of the page in a real browser, beside a real `mjarm serve`: npm test.
import { after, before, describe, test } from 'node:test';
import { closeBrowser, openBrowser, whatIsMissing } from './browser.mjs';

const missing = await whatIsMissing();
if (missing) test('the page in a browser', { skip: missing });
else await declare();

async function declare() {
  const [{ Session }, ...parts] = await Promise.all([
    './session.mjs', './transport_test.mjs', './joints_test.mjs', './target_test.mjs', './panels_test.mjs', './scene_test.mjs',
    './looks_test.mjs', './phone_test.mjs', './program_test.mjs', './connection_test.mjs',
  ].map((path) => import(path)));
  const { testTransport, testJoints, testTarget, testPanels, testScene, testLooks, testPhone, testProgram, testConnection } =
    Object.assign({}, ...parts);

  /** Tests that share a program and a page. */
  const beside = (name, args, suites) => describe(name, () => {
    const session = new Session();
    before(() => session.open(args));
    after(() => session.close());
    for (const suite of suites) describe(suite.name, () => suite(session));
    test('the page says nothing it should not', () => session.assertNoFaults());
  });

  describe('page', () => {
    before(openBrowser);
    after(closeBrowser);
    beside('robot', ['ur5e'], [testTransport, testJoints, testTarget, testPanels, testScene, testLooks, testPhone]);
    beside('program', ['speeds'], [testProgram]);
    describe('connection', testConnection);
  });
}
