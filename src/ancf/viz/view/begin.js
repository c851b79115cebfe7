begin().then(() => hook.follow?.()).catch((error) => { hook.errors.push(String(error)); throw error; });
