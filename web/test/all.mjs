// Tests of the page in a real browser, beside a real `mjarm serve`: npm test.
import { after, before, describe, test } from 'node:test';
import { closeBrowser, openBrowser, whatIsMissing } from './browser.mjs';

const missing = await whatIsMissing();
if (missing) test('the page in a browser', { skip: missing });
else await declare();

async function declare() {
  const { Session } = await import('./session.mjs');
  const { testTransport } = await import('./transport_test.mjs');
  const { testJoints } = await import('./joints_test.mjs');
  const { testTarget } = await import('./target_test.mjs');
  const { testPanels } = await import('./panels_test.mjs');
  const { testScene } = await import('./scene_test.mjs');
  const { testLooks } = await import('./looks_test.mjs');
  const { testPhone } = await import('./phone_test.mjs');
  const { testProgram } = await import('./program_test.mjs');
  const { testConnection } = await import('./connection_test.mjs');
  const { testLead } = await import('./lead_test.mjs');
  const { testRecorded } = await import('./recorded_test.mjs');

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
    beside('led arm', ['teleop', 'franka_emika_panda/pick.xml'], [testLead]);
    describe('connection', testConnection);
    describe('recorded run', testRecorded);
  });
}
